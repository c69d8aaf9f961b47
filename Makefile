# elasto: `make run` builds and runs the demo, `make test` checks it.
# `make help` lists the rest.

# ---- what a user may set ---------------------------------------------------
CC      ?= cc
CFLAGS  ?= -O2 -g
PREFIX  ?= /usr/local
SANITIZE ?=
V       ?= 0
ARGS    ?=

# As many jobs as there are processors, unless -j says otherwise.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif

# ---- what is built ---------------------------------------------------------
# The rooms, from the ground up; each uses itself and those before it.
ROOMS = base model solve step scenes picture play

SOURCES := $(foreach room,$(ROOMS),$(wildcard src/$(room)/*.c))
BENCH_SOURCES := $(filter-out %/bench.c,$(wildcard src/bench/*.c))

comma   := ,
VARIANT := $(if $(SANITIZE),sanitize-$(subst $(comma),-,$(SANITIZE)),release)
B       := build/$(VARIANT)
CONFIG  := build/config.mk

OBJECTS := $(SOURCES:src/%.c=$(B)/%.o) $(B)/listing_text.o
BENCH_OBJECTS := $(BENCH_SOURCES:src/%.c=$(B)/%.o)
SUITES  := $(patsubst tests/%.c,$(B)/tests/%,$(wildcard tests/unit/test_*.c))

ALL_CPPFLAGS = -D_GNU_SOURCE -Iinclude -Isrc $(DEP_CFLAGS) $(CPPFLAGS)
ALL_CFLAGS   = -std=c11 -pipe -ffp-contract=off -Wall -Wextra $(CFLAGS) \
               $(SANITIZER)
ALL_LDFLAGS  = $(LDFLAGS) $(SANITIZER)
SANITIZER    = $(if $(SANITIZE),-fsanitize=$(SANITIZE) \
               -fno-sanitize-recover=all -fno-omit-frame-pointer)
COMPILE      = $(CC) $(ALL_CPPFLAGS) $(ALL_CFLAGS)

Q = $(if $(filter 1,$(V)),,@)
say = $(if $(filter 1,$(V)),,@printf '  %-5s %s\n' $(1) $(2))

.PHONY: all run run-lecture test long-test bench figures pictures install uninstall \
        clean help FORCE
.DELETE_ON_ERROR:
.SECONDARY:

all: elasto lecture

elasto: build/elasto
lecture: build/lecture
.PHONY: elasto lecture

run: build/elasto
	./build/elasto $(ARGS)

run-lecture: build/lecture
	./build/lecture $(ARGS)

# ---- dependencies ----------------------------------------------------------
# build/config.mk holds their flags.  Its recipe installs what is missing; make
# then starts again with the new file.  clean, figures and help need none of it.
GOALS := $(or $(MAKECMDGOALS),all)
ifneq ($(filter-out clean help uninstall figures,$(GOALS)),)
include $(CONFIG)
ifneq ($(filter test long-test suites stress envelope mutants coverage analyse \
          build/stress $(B)/tests/%,$(GOALS)),)
include build/config-test.mk
endif
endif

# $(call try,FLAGS,HEADER,CALL): does this compile and link?
# CHOLMOD is linked as an archive where there is one: src/solve/blas.c answers
# its calls of BLAS, and a program that has it loads no library of BLAS.
define deps_functions
try() { { printf '#include <%b>\n' stddef.h stdio.h "$$2"; \
    echo "int main(void) { return (int)(size_t)($$3); }"; } | \
  $(CC) -x c - -o build/try $$1 >build/try.log 2>&1; }; \
pc() { pkg-config --cflags --libs $$1 2>/dev/null || echo "$$2"; }; \
sdl() { try "$$(pc sdl2 '-I/usr/include/SDL2 -lSDL2')" SDL.h \
    '&SDL_RenderGeometry'; }; \
freetype() { try "$$(pc freetype2 '-I/usr/include/freetype2 -lfreetype')" \
    'ft2build.h>\n#include <freetype/freetype.h' '&FT_Init_FreeType'; }; \
font() { [ "$$ELASTO_FONT" ] || ! command -v apt-get >/dev/null 2>&1 || \
  [ -f /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf ]; }; \
png() { try "$$(pc libpng -lpng)" png.h '&png_image_write_to_stdio'; }; \
cmocka() { \
  headers='stdarg.h>\n#include <stdint.h>\n#include <setjmp.h>'; \
  try "$$(pc cmocka -lcmocka)" "$$headers\n#include <cmocka.h" \
    '&_cmocka_run_group_tests'; }; \
cholmod_flags() { \
  alone="-I/usr/include/suitesparse -l:libcholmod.a -l:libcolamd.a"; \
  alone="$$alone -l:libccolamd.a -l:libcamd.a -l:libamd.a"; \
  alone="$$alone -l:libsuitesparseconfig.a -l:libmetis.so.5 -lgomp"; \
  if try "$$alone -lblas -llapack -lm" cholmod.h '&cholmod_solve2'; then \
    echo "$$alone"; return 0; fi; \
  found=$$(pkg-config --cflags --libs CHOLMOD 2>/dev/null); \
  for f in "$$found" -lcholmod "-I/usr/include/suitesparse -lcholmod" \
    "-I/usr/local/include/suitesparse -L/usr/local/lib -lcholmod" \
    "-I/opt/homebrew/include/suitesparse -L/opt/homebrew/lib -lcholmod"; do \
  if try "$$f" cholmod.h '&cholmod_solve2'; then \
    echo "$$f"; return 0; fi; done; return 1; }; \
install_packages() { \
  echo "elasto needs these packages: $$1"; \
  if ! command -v apt-get >/dev/null 2>&1; then \
    echo "Please install them:"; \
    echo "  Fedora:  dnf install SDL2-devel freetype-devel \\"; \
    echo "             dejavu-sans-fonts dejavu-sans-mono-fonts \\"; \
    echo "             suitesparse-devel libpng-devel \\"; \
    echo "             libcmocka-devel pkgconf"; \
    echo "  Arch:    pacman -S sdl2 freetype2 ttf-dejavu suitesparse \\"; \
    echo "             libpng cmocka pkgconf"; \
    echo "  macOS:   brew install sdl2 freetype font-dejavu \\"; \
    echo "             suite-sparse libpng cmocka pkg-config"; \
    return 1; fi; \
  as=; [ "$$(id -u)" = 0 ] || as=sudo; \
  if [ "$$as" ] && ! command -v sudo >/dev/null 2>&1; then \
    echo "Please install them as root: apt-get install $$1"; return 1; fi; \
  echo "Installing them with $$as apt-get ..."; \
  export DEBIAN_FRONTEND=noninteractive; \
  $$as apt-get install -y -q --no-install-recommends $$1 || \
  { $$as apt-get update -q && \
    $$as apt-get install -y -q --no-install-recommends $$1; }; }
endef

$(CONFIG): Makefile
	@mkdir -p build
	@$(deps_functions); \
	missing=; \
	command -v pkg-config >/dev/null 2>&1 || missing="$$missing pkg-config"; \
	sdl || missing="$$missing libsdl2-dev"; \
	freetype || missing="$$missing libfreetype-dev"; \
	font || missing="$$missing fonts-dejavu-core"; \
	png || missing="$$missing libpng-dev"; \
	cholmod=$$(cholmod_flags) || \
	  missing="$$missing libsuitesparse-dev"; \
	if [ "$$missing" ]; then \
	  install_packages "$$missing" || exit 1; \
	  sdl && freetype && png && cholmod=$$(cholmod_flags) || \
	    { cat build/try.log; exit 1; }; fi; \
	flags="$$cholmod $$(pc sdl2 '-I/usr/include/SDL2 -lSDL2')"; \
	flags="$$flags $$(pc freetype2 '-I/usr/include/freetype2 -lfreetype')"; \
	flags="$$flags $$(pc libpng -lpng)"; \
	c=; l=; for f in $$flags; do \
	  case "$$c $$l " in *" $$f "*) continue;; esac; \
	  case $$f in -I*|-D*) c="$$c $$f";; *) l="$$l $$f";; esac; done; \
	case $$l in *libcholmod.a*) blas='-lblas -llapack';; *) blas=;; esac; \
	{ echo "DEP_CFLAGS :=$$c"; echo "DEP_LIBS :=$$l -ldl -lm"; \
	  echo "BLAS_LIBS := $$blas"; } >$@.new; \
	rm -f build/try build/try.log; mv $@.new $@

build/config-test.mk: $(CONFIG)
	@$(deps_functions); \
	cmocka || { install_packages libcmocka-dev || exit 1; \
	  cmocka || { cat build/try.log; exit 1; }; }; \
	echo "TEST_LIBS := $$(pc cmocka -lcmocka)" >$@.new; \
	rm -f build/try build/try.log; mv $@.new $@

# ---- programs --------------------------------------------------------------
build/elasto: $(B)/elasto FORCE
	@cmp -s $< $@ || cp -f $< $@

# All rooms in one archive; a program takes from it what it uses.  It is made
# anew whenever the list of its members changes, so that it holds no old ones.
LIBRARY = $(B)/libelasto.a

$(B)/members: FORCE
	@mkdir -p $(B)
	@echo '$(OBJECTS)' | cmp -s - $@ || echo '$(OBJECTS)' >$@

$(LIBRARY): $(OBJECTS) $(B)/members
	$(Q)rm -f $@
	$(Q)$(AR) rcs $@ $(OBJECTS)

$(B)/elasto: $(B)/main.o $(LIBRARY)
	$(call say,LINK,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS) $^ -o $@ $(DEP_LIBS) $(LDLIBS)

# The whole lecture in one file; it needs nothing of ours.
build/lecture: $(B)/lecture FORCE
	@cmp -s $< $@ || cp -f $< $@

$(B)/lecture: $(B)/lecture.o
	$(call say,LINK,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS) $^ -o $@ $(DEP_LIBS) $(BLAS_LIBS) \
	  $(LDLIBS)

# Objects are made again when the compiler or its flags change.
$(B)/flags: FORCE
	@mkdir -p $(B)
	@echo '$(COMPILE) $(ALL_LDFLAGS)' | cmp -s - $@ || \
	  echo '$(COMPILE) $(ALL_LDFLAGS)' >$@

$(B)/%.o: src/%.c $(B)/flags
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(COMPILE) -MMD -MP -c $< -o $@

-include $(wildcard $(B)/*.d $(B)/*/*.d $(B)/tests/*/*.d)

# ---- the lecture's listings -------------------------------------------------
# The text of these sources is compiled into the program as a table of lines.
LISTED = src/lecture.c src/scenes/scalar_newton.c src/scenes/circle_scene.c \
         src/scenes/dial_scene.c src/scenes/race_scene.c \
         src/scenes/envelope_scene.c src/model/contact.c \
         src/model/friction.c src/model/plasticity.c src/model/fracture.c

define LISTING_AWK
FNR == 1 { print (NR > 1 ? "};\n" : "") "static const char *const text_" ++files "[] = {"
           name[files] = FILENAME }
{ gsub(/\\/, "&&"); gsub(/"/, "\\\""); print "\"" $$0 "\","; lines[files]++ }
END {
    print "};\n\nconst Listing listings[] = {"
    for (i = 1; i <= files; i++)
        print "{\"" name[i] "\", " lines[i] ", text_" i "},"
    print "{NULL, 0, NULL}};"
}
endef
export LISTING_AWK

$(B)/listing_text.c: $(LISTED) Makefile
	$(call say,WRITE,$@)
	$(Q)mkdir -p $(@D)
	$(Q){ echo '#include <stddef.h>'; echo '#include "scenes/listing.h"'; \
	  awk "$$LISTING_AWK" $(LISTED); } >$@

$(B)/listing_text.o: $(B)/listing_text.c $(B)/flags
	$(call say,CC,$<)
	$(Q)$(COMPILE) -MMD -MP -c $< -o $@

# ---- benchmark -------------------------------------------------------------
# The CSV files that it writes say with which flags it was compiled.
build/elasto-bench: $(B)/elasto-bench FORCE
	@cmp -s $< $@ || cp -f $< $@

$(B)/elasto-bench: $(BENCH_OBJECTS) $(B)/bench/bench.o $(LIBRARY)
	$(call say,LINK,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS) $^ -o $@ $(DEP_LIBS) $(BLAS_LIBS) \
	  $(LDLIBS)

$(B)/bench/bench_report.o: src/bench/bench_report.c $(B)/flags
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(COMPILE) -DBENCH_FLAGS='"$(strip $(ALL_CFLAGS))"' -MMD -MP -c $< -o $@

bench: build/elasto-bench
	./build/elasto-bench $(ARGS)

figures:
	@command -v gnuplot >/dev/null 2>&1 || { \
	  echo 'make figures needs gnuplot (apt-get install gnuplot-nox)'; exit 1; }
	@[ -f build/bench/work_precision.csv ] || { \
	  echo 'make figures draws what make bench has measured: run that first'; \
	  exit 1; }
	gnuplot -c src/bench/bench_figures.gnuplot build/bench tests/data

# ---- tests -----------------------------------------------------------------
# The tests' own sources are compiled sooner: their speed matters little, and
# what a debugger knows of them are their lines.
$(B)/tests/%.o: private CFLAGS := $(patsubst -g,-g1,$(CFLAGS:-O2=-O1))

$(B)/tests/%.o: tests/%.c $(B)/flags
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(COMPILE) -Itests/unit -Itests/stress -MMD -MP -c $< -o $@

$(B)/tests/unit/test_%: $(B)/tests/unit/test_%.o $(B)/tests/unit/testing.o $(LIBRARY)
	$(call say,LINK,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS) $(LINKED) -o $@ $(TEST_LIBS) \
	  $(DEP_LIBS) $(BLAS_LIBS) $(LDLIBS)

# Archives come last.
LINKED = $(filter %.o,$^) $(filter %.a,$^)

# These need more than the demo has.
$(B)/tests/unit/test_orders: $(B)/bench/bench_reference.o

# This suite makes allocations fail one by one.
$(B)/tests/unit/test_memory: TEST_LIBS += -Wl,--wrap=malloc,--wrap=calloc \
  -lsuitesparseconfig

# This one reads what is written and plotted on a frame.
$(B)/tests/unit/test_show: TEST_LIBS += -Wl,--wrap=text_draw,--wrap=plot_line

# This one counts calls of CHOLMOD.
$(B)/tests/unit/test_explicit: TEST_LIBS += -Wl,--wrap=cholmod_start \
  -Wl,--wrap=cholmod_analyze,--wrap=cholmod_factorize

suites: $(SUITES)
.PHONY: suites

# test: every promise once, in a minute.  long-test: also all variations, and
# the benchmark.  What was tested is then in build/, ready to be used.
long-test: $(B)/elasto-bench
test long-test: $(SUITES) $(B)/elasto $(B)/lecture \
                $(if $(SANITIZE),,build/elasto build/lecture)
	@$(CHECK_ENVIRONMENT) LONG=$(filter long-test,$@) \
	  sh tests/checks/run.sh $(SUITES)

CHECK_ENVIRONMENT = CC='$(CC)' DEP_CFLAGS='$(DEP_CFLAGS)' \
  DEP_LIBS='$(DEP_LIBS)' SANITIZE='$(SANITIZE)' ELASTO=$(B)/elasto \
  BENCH=$(B)/elasto-bench LECTURE=$(B)/lecture

# ---- pictures of the README -----------------------------------------------
# tests/data/pictures.txt: name, step, command line; a test holds them.  What
# moves needs ffmpeg: the square, and a sheet of eight films of 61 frames each
# (tests/data/films.txt: name, steps a picture, steps, command line).
SHEET = [0][1][2][3]hstack=inputs=4[a];[4][5][6][7]hstack=inputs=4[b];[a][b]vstack

pictures: build/elasto
	@command -v ffmpeg >/dev/null 2>&1 || { \
	  echo 'make pictures needs ffmpeg (apt-get install ffmpeg)'; exit 1; }
	@while read -r name step line; do \
	  ./build/elasto $$line --headless --quiet --steps $$step \
	    --frames build/frames-$$name || [ $$? = 3 ] || exit 1; \
	  cp build/frames-$$name/frame_$$(printf %06d $$step).png \
	    tests/data/$$name.png || exit 1; \
	  rm -rf build/frames-$$name; echo "tests/data/$$name.png"; \
	done <tests/data/pictures.txt
	@echo '0 bare' >build/bare.txt; ./build/elasto --headless --quiet \
	  --segments 10 --steps 75 --size 360x360 --script build/bare.txt \
	  --film tests/data/relax.gif && echo tests/data/relax.gif
	@mkdir -p build/films; while read -r name every steps line; do \
	  ./build/elasto $$line --headless --quiet --steps $$steps \
	    --size 300x300 --film build/films/$$name.apng && \
	  ffmpeg -v error -nostdin -y -i build/films/$$name.apng -vf \
	    "select=not(mod(n\,$$every)),setpts=N/20/TB,fps=12,crop=300:260:0:0,scale=225:195:flags=area" \
	    -c:v ffv1 -pix_fmt bgr0 build/films/$$name.mkv || exit 1; \
	done <tests/data/films.txt
	@ffmpeg -v error -nostdin -y \
	  $$(sed 's|^\([a-z]*\) .*|-i build/films/\1.mkv|' tests/data/films.txt) \
	  -filter_complex '$(SHEET)' -c:v libwebp_anim -quality 30 \
	  -compression_level 6 -loop 0 tests/data/scenes.webp && \
	  rm -rf build/films && echo tests/data/scenes.webp

# ---- the lecture for a course's page ----------------------------------------
handout: build/elasto
	./build/elasto --handout build/handout.html
	@echo build/handout.html

.PHONY: handout

# ---- hard to break ---------------------------------------------------------
STRESS_PARTS = stress_exact stress_watch stress_random stress_cases \
               stress_answers stress_envelope stress_contact stress_large
STRESS_OBJECTS = $(STRESS_PARTS:%=$(B)/tests/stress/%.o)

$(B)/tests/unit/test_stress $(B)/tests/unit/test_ends: $(STRESS_OBJECTS)

$(B)/stress-tests: $(B)/tests/stress/stress.o $(STRESS_OBJECTS) \
             $(B)/tests/unit/testing.o $(LIBRARY)
	$(call say,LINK,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(ALL_LDFLAGS) $(LINKED) -o $@ $(TEST_LIBS) \
	  $(DEP_LIBS) $(BLAS_LIBS) $(LDLIBS)

build/stress: $(B)/stress-tests FORCE
	@cmp -s $< $@ || cp -f $< $@

# The program with faults linked in: sanitizers see what they do.
$(B)/elasto-faults: $(B)/main.o $(LIBRARY) tests/checks/faults.c
	$(call say,LINK,$@)
	$(Q)$(COMPILE) -DFAULT_WRAP $(filter %.c,$^) $(LINKED) -o $@ \
	  $(ALL_LDFLAGS) $(DEP_LIBS) $(LDLIBS) \
	  $(foreach call,malloc calloc realloc fopen fdopen open rename mkdir,-Wl,--wrap=$(call))

test long-test: $(if $(SANITIZE),$(B)/elasto-faults)

# Ends by itself within ten minutes.
stress: build/stress build/elasto
	./build/stress $(ARGS)
	@$(CHECK_ENVIRONMENT) FAULTS=all sh tests/checks/check_faults.sh

envelope: build/stress
	./build/stress --envelope tests/data/envelope.csv tests/data/envelope.png

same-bits: build/elasto
	@$(CHECK_ENVIRONMENT) sh tests/checks/same_bits.sh

mutants: $(CONFIG)
	@sh tests/checks/mutants.sh $(ARGS)

coverage: $(CONFIG)
	@sh tests/checks/coverage.sh

analyse: $(CONFIG)
	@$(CHECK_ENVIRONMENT) sh tests/checks/analyse.sh

.PHONY: stress envelope same-bits mutants coverage analyse

# ---- the rest --------------------------------------------------------------
install: build/elasto
	install -d '$(DESTDIR)$(PREFIX)/bin'
	install -m 755 build/elasto '$(DESTDIR)$(PREFIX)/bin/elasto'

uninstall:
	rm -f '$(DESTDIR)$(PREFIX)/bin/elasto'

clean:
	rm -rf build

help:
	@echo 'make run        build, then watch the stretched square relax'
	@echo '                (ARGS="--segments 16" gives it options)'
	@echo 'make run-lecture  src/lecture.c, the bare square (ARGS="k=1e6")'
	@echo 'make            build build/elasto'
	@echo 'make test       build and run all tests (SANITIZE=address,undefined);'
	@echo '                make long-test: with all their variations'
	@echo 'make pictures   draw the pictures of the README again'
	@echo 'make handout    write the lecture as build/handout.html'
	@echo 'make bench      measure run time against error, for minutes'
	@echo '                (ARGS="--quick" or "--only PART"; --help)'
	@echo 'make figures    draw what it measured (needs gnuplot)'
	@echo 'make stress     named cases, random scenes, faults: ten minutes'
	@echo 'make envelope   draw where the solvers converge again'
	@echo 'make same-bits  one run by all compilers gives one hash'
	@echo 'make mutants    faults put into the sources must fail a test'
	@echo 'make coverage   lines that the tests run; make analyse: other tools'
	@echo 'make install    to $$(DESTDIR)$$(PREFIX)/bin; make uninstall'
	@echo 'make clean      remove build/'
	@echo 'CC, CFLAGS, CPPFLAGS, LDFLAGS, LDLIBS are respected; V=1 shows commands'
