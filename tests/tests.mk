# Tests, and what is made for the README; ../Makefile includes this.

# ---- tests -----------------------------------------------------------------
# The tests' own sources need no speed, and a debugger needs their lines alone.
$(B)/tests/%.o: private CFLAGS := $(patsubst -g,-g1,$(CFLAGS:-O2=-O1))

$(B)/tests/%.o: tests/%.c $(B)/flags
	$(call shown,CC)
	$(Q)$(COMPILE) -Itests/unit -Itests/stress -MMD -MP -c $< -o $@

$(B)/tests/unit/test_%: $(B)/tests/unit/test_%.o $(B)/tests/unit/testing.o \
                        $(B)/tests/unit/oracle.o $(LIBRARY) $(B)/flags
	$(call shown,LINK)
	$(Q)$(LINK)

# These need more than the demo has; make allocations fail; read what is drawn.
wrap = $(1:%=-Wl,--wrap=%)
$(B)/tests/unit/test_stress $(B)/tests/unit/test_multigrid \
  $(B)/tests/unit/test_newton: $(STRESS)
$(B)/tests/unit/test_memory: LIBS += $(call wrap,malloc calloc realloc aligned_alloc free) \
  -lsuitesparseconfig
$(B)/tests/unit/test_show $(B)/tests/unit/test_session: \
  LIBS += $(call wrap,text_draw)
$(B)/tests/unit/test_player: LIBS += $(call wrap,clock_gettime)
$(B)/tests/unit/test_layout $(B)/tests/unit/test_session: \
  LIBS += $(call wrap,font_get_glyph)
$(B)/tests/unit/test_pages: \
  LIBS += $(call wrap,font_get_glyph text_draw plot_curve)

$(B)/tests/unit/test_document: $(B)/web/document.o

# Multigrid's loops once more, for one number at a time, and Cholesky's for two:
# before the archive.
$(B)/narrow/%.o: src/solve/%.c $(B)/flags
	$(call shown,CC)
	$(Q)$(COMPILE) -DFAST= -DAVX= -MMD -MP -c $< -o $@
$(B)/tests/unit/test_widths: $(patsubst %,$(B)/narrow/%.o,$(GRID_LOOPS) panels)

# test: every promise once, in a minute.  long-test: also all variations, and
# the benchmark.  What was tested is then in build/, ready to be used.
suites: $(SUITES)
long-test: $(B)/elasto-bench
test long-test: $(SUITES) $(B)/elasto $(B)/lecture \
                $(if $(SANITIZE),,build/elasto build/lecture)
	@$(SETTINGS) LONG=$(filter long-test,$@) sh tests/checks/run.sh $(SUITES)

SETTINGS = CC='$(CC)' DEP_CFLAGS='$(DEP_CFLAGS)' DEP_LIBS='$(DEP_LIBS)' BLAS_LIBS='$(BLAS_LIBS)' \
  SANITIZE='$(SANITIZE)' ELASTO=$(B)/elasto BENCH=$(B)/elasto-bench \
  LECTURE=$(B)/lecture

# Ends by itself within half an hour.
stress: build/stress build/elasto
	./build/stress $(ARGS)
	@$(SETTINGS) LONG=1 sh tests/checks/check_faults.sh

same-bits: build/elasto
	@$(SETTINGS) sh tests/checks/same_bits.sh

mutants: suites build/elasto build/lecture
	@$(SETTINGS) perl tests/checks/mutants.pl $(ARGS)

# What other tools find in the sources.
analyse: build/config.mk
	clang-format --dry-run --Werror include/*/*.h src/*.c src/*/*.[ch] tests/*/*.[ch]
	cppcheck --quiet --std=c11 --enable=warning,performance,portability \
	  --inline-suppr --error-exitcode=1 -Iinclude -Isrc src
	for file in $$(ls src/*.c src/*/*.c | grep -v -e _web.c -e homework); do clang-tidy --quiet $$file -- -std=c11 \
	  -D_GNU_SOURCE -Iinclude -Isrc $(DEP_CFLAGS) || exit 1; done

# ---- pictures of the README -----------------------------------------------
# tests/data/pictures.txt: name, step, command line; a test holds them.  The
# sessions "a picture of ..." draw what hands lead to.  What
# moves needs ffmpeg: the square, and a sheet of eight films of 61 frames each
# (tests/data/films.txt: name, steps a picture, steps, command line).
SHEET = [0][1][2][3]hstack=inputs=4[a];[4][5][6][7]hstack=inputs=4[b];[a][b]vstack

pictures: build/elasto $(B)/tests/unit/test_session
	@command -v ffmpeg >/dev/null 2>&1 || { \
	  echo 'make pictures needs ffmpeg (apt-get install ffmpeg)'; exit 1; }
	@while read -r name step line; do \
	  ./build/elasto $$line --headless --quiet --steps $$step \
	    --frames build/frames-$$name || [ $$? = 3 ] || exit 1; \
	  cp build/frames-$$name/frame_$$(printf %06d $$step).png \
	    tests/data/$$name.png || exit 1; \
	  rm -rf build/frames-$$name; echo "tests/data/$$name.png"; \
	done <tests/data/pictures.txt
	@for tests in 'a picture of*' 'record*'; do \
	  PICTURES=1 $(B)/tests/unit/test_session "$$tests" || exit 1; done
	@echo '0 bare' >build/bare.txt; ./build/elasto --headless --quiet \
	  --segments 10 --steps 75 --speed 1 --size 360x360 --script build/bare.txt \
	  --film build/relax.apng && ffmpeg -v error -nostdin -y \
	  -i build/relax.apng -vf "fps=25,split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1" \
	  tests/data/relax.gif && echo tests/data/relax.gif
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
