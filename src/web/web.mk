# make web: build/elasto.html, the whole program as one file that a browser
# opens, also from disk and without a network.  Debian 12 has what it needs; the
# libraries' sources stay in build/web.

W := build/web
MATH = /usr/share/fonts/truetype/dejavu/DejaVuMathTeXGyre.ttf
WEB_NEEDS = /usr/bin/emcc:emscripten /usr/bin/pyftsubset:fonttools \
            /usr/bin/xz:xz-utils /usr/bin/bzip2:bzip2 \
            $(FONTS):fonts-dejavu-core $(MATH):fonts-dejavu-extra
EMCC = NODE_PATH=/usr/share/nodejs emcc -O2 -msimd128 -mbulk-memory
WEB_CFLAGS = -std=gnu11 -D_GNU_SOURCE -Iinclude -Isrc -I$(W)/libraries/include \
             -ffp-contract=off -Wall -Wextra -Wno-missing-field-initializers

# A page has the window of window_web.c.
WEB_SOURCES = $(filter-out src/play/window_sdl.c,\
              $(wildcard $(ROOMS:%=src/%/*.c))) src/web/main_web.c \
              src/web/document.c
WEB_OBJECTS = $(WEB_SOURCES:src/%.c=$(W)/%.o) $(W)/texts.o
WEB_LIBRARIES = $(patsubst %,$(W)/libraries/lib%.a,suitesparse freetype \
                libpng1.6 zlib)

web: build/elasto.html

$(W)/tools:
	@mkdir -p $(@D); $(call need,$(WEB_NEEDS)); touch $@

$(W)/libraries/done: src/web/libraries.sh | $(W)/tools
	$(call shown,BUILD)
	$(Q)NODE_PATH=/usr/share/nodejs sh $< $(@D) && touch $@

$(W)/fonts/done: src/web/fonts.sh $(PAGES) $(CARDS) | $(W)/tools
	$(call shown,CUT)
	$(Q)sh $< $(@D) && touch $@

$(W)/%.o: src/%.c $(W)/libraries/done src/web/web.mk
	$(call shown,EMCC)
	$(Q)$(EMCC) $(WEB_CFLAGS) -MMD -MP -c $< -o $@

# Clang vectorises what takes every second number only where it is told to.
$(GRID_LOOPS:%=$(W)/solve/%.o): private WEB_CFLAGS += -O3 \
  -fno-trapping-math -fno-math-errno -mllvm -enable-interleaved-mem-accesses

$(W)/texts.o: $(B)/texts.c $(W)/libraries/done
	$(Q)$(EMCC) $(WEB_CFLAGS) -c $< -o $@

# What it says on its way: CHOLMOD's calls for complex matrices, which nobody
# makes, find no functions of their kind.
$(W)/elasto.js: $(WEB_OBJECTS) $(W)/fonts/done src/web/web.mk
	$(call shown,LINK)
	$(Q)$(EMCC) $(WEB_LDFLAGS) $(WEB_OBJECTS) $(WEB_LIBRARIES) -o $@ --no-entry \
	  -s ENVIRONMENT=web -s MODULARIZE=1 -s EXPORT_NAME=createElasto \
	  -s EXPORTED_RUNTIME_METHODS=ccall,FS \
	  -s FORCE_FILESYSTEM=1 -s ALLOW_MEMORY_GROWTH=1 \
	  -s INITIAL_MEMORY=33554432 -s MAXIMUM_MEMORY=2147483648 \
	  -s TOTAL_STACK=4194304 -s SUPPORT_LONGJMP=emscripten \
	  --embed-file $(W)/fonts@/usr/share/fonts/truetype/dejavu \
	  --exclude-file '*/done' 2>$@.log || { cat $@.log; exit 1; }
	$(Q)! grep -w mismatch $@.log | grep -v ': z' || { rm $@; exit 1; }

build/elasto.html: src/web/pack.py src/web/page.html src/web/page.css \
                   src/web/markup.js src/web/page.js src/web/document.js \
                   $(W)/elasto.js
	$(call shown,PACK)
	$(Q)python3 $^ $(W)/elasto.wasm $(W)/fonts.woff \
	  $(W)/libraries $@

# In Chromium and Firefox; axe-core, where npm finds it, looks for what a reader
# of the screen would miss.
AXE = $(W)/node_modules/axe-core/axe.min.js
$(AXE):
	@mkdir -p $(@D); npm install --silent --no-save --prefix $(W) axe-core@4.10.2 || \
	echo 'npm cannot fetch axe-core, so test-web does not run it'
test-web: build/elasto build/elasto.html $(AXE)
	@failed=0; for check in web document; do \
	  node tests/web/check_$$check.js $^ || failed=1; done; exit $$failed

# The lecture for print, by Chromium where there is one; NOTES=1 adds the
# presenter's notes.
handout: build/elasto.html
	@command -v chromium >/dev/null || { echo 'make handout needs chromium; or \
	print build/elasto.html in a browser'; exit 1; }
	$(Q)node tests/web/handout.js $< build/handout.pdf $(if $(NOTES),?notes)
	@echo build/handout.pdf

-include $(wildcard $(W)/*/*.d)
