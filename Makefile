# elasto: `make run` builds and runs the demo, `make test` checks it.
# `make help` lists the rest.

# ---- settings ---------------------------------------------------------------
CC       ?= cc
CFLAGS   ?= -O2 -g
PREFIX   ?= /usr/local
INSTALL  ?= yes
SANITIZE ?=
V        ?= 0
ARGS     ?=

# One job for each processor, unless -j sets another number.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif

# ---- sources and programs ---------------------------------------------------
# Rooms (folders of src), from the bottom up.  A room uses itself and the rooms
# before it.
ROOMS = base model solve step simulation scenes lesson picture play

comma   := ,
VARIANT := $(if $(SANITIZE),sanitize-$(subst $(comma),-,$(SANITIZE)),release)
B       := build/$(VARIANT)

objects = $(patsubst %.c,$(B)/%.o,$(patsubst src/%,%,$(wildcard $(1))))
OBJECTS := $(filter-out %_web.o,$(call objects,$(ROOMS:%=src/%/*.c))) \
           $(B)/texts.o
SUITES  := $(patsubst %.c,$(B)/%,$(wildcard tests/unit/test_*.c))
STRESS  := $(filter-out %/stress.o,$(call objects,tests/stress/*.c \
             tests/unit/oracle.c))
LIBRARY := $(B)/libelasto.a

COMPILE = $(CC) -std=c11 -D_GNU_SOURCE -Iinclude -Isrc $(DEP_CFLAGS) \
          $(CPPFLAGS) -pipe -ffp-contract=off -Wall -Wextra \
          -Wno-missing-field-initializers $(CFLAGS) $(WATCH)
LINK    = $(CC) $(CFLAGS) $(WATCH) $(LDFLAGS) $(filter %.o,$^) \
          $(filter %.a,$^) -o $@ $(DEP_LIBS) $(LIBS) $(LDLIBS)
WATCH   = $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all \
          -fno-omit-frame-pointer)

Q     = $(if $(filter 1,$(V)),,@)
shown = $(if $(filter 1,$(V)),,@printf '  %-5s %s\n' $(1) $@;) mkdir -p $(@D)

all: elasto lecture
elasto: build/elasto
lecture: build/lecture

run: build/elasto
	./build/elasto $(ARGS)

run-lecture: build/lecture
	./build/lecture $(ARGS)

# ---- dependencies ----------------------------------------------------------
# build/config.mk has the flags of the libraries.  Its recipe installs missing
# packages, or only names them (INSTALL=no).  Then make reads the new file and
# starts again.
GOALS := $(or $(MAKECMDGOALS),all)
ifneq ($(filter-out clean help uninstall figures web homework,$(GOALS)),)
include build/config.mk
ifneq ($(filter test long-test suites stress mutants build/stress \
          $(B)/tests/%,$(GOALS)),)
include build/config-test.mk
endif
endif

# $(call need,PAIRS): installs the missing packages.  A pair is THING:PACKAGE, and
# THING is a header, a file or a name for pkg-config.
SUITESPARSE = -I/usr/include/suitesparse -I/usr/local/include/suitesparse \
              -I/opt/homebrew/include/suitesparse
FONTS = /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
define need
missing=; for pair in $(1); do found=$${pair%:*}; case $$found in \
  pkg-config) pkg-config --version;; \
  /*) ! command -v apt-get >/dev/null || [ "$$ELASTO_FONT" ] || [ -f $$found ];; \
  *.h) echo "#include <$$found>" | $(CC) $(SUITESPARSE) -E - ;; \
  *) pkg-config --exists $$found;; \
  esac >/dev/null 2>&1 || missing="$$missing $${pair#*:}"; done; \
if [ "$$missing" ]; then as=; [ "$$(id -u)" = 0 ] || as=sudo; \
  get="$$as apt-get install -y -q --no-install-recommends$$missing"; \
  if [ $(INSTALL) = no ] || ! command -v apt-get >/dev/null || \
    ! command -v $${as:-sh} >/dev/null; then \
    echo "elasto needs$$missing (as Debian calls them). There:$${get#sudo}"; \
    echo 'Fedora: dnf install SDL2-devel freetype-devel dejavu-sans-fonts'; \
    echo '  dejavu-sans-mono-fonts suitesparse-devel lapack-devel libpng-devel libcmocka-devel'; \
    echo 'Arch: pacman -S sdl2 freetype2 ttf-dejavu suitesparse lapack libpng cmocka'; \
    echo 'macOS: brew install sdl2 freetype font-dejavu suite-sparse libpng \'; \
    echo '  cmocka pkg-config'; exit 1; fi; \
  echo "Installing$$missing: $$get"; export DEBIAN_FRONTEND=noninteractive; \
  $$get || { $$as apt-get update -q && $$get; } || exit 1; fi
endef

# CHOLMOD is linked as a static archive if there is one.  src/solve/panels.c has
# the four BLAS functions that CHOLMOD calls, so no BLAS library is loaded.
ALONE = $(foreach l,cholmod colamd ccolamd camd amd suitesparseconfig,-l:lib$(l).a) \
        -l:libmetis.so.5 -lgomp
LAPACK = $(if $(filter Darwin,$(shell uname)),-framework Accelerate,-llapack)
build/config.mk: Makefile
	@mkdir -p build; $(call need,pkg-config:pkg-config sdl2:libsdl2-dev freetype2:libfreetype-dev \
	  libpng:libpng-dev cholmod.h:libsuitesparse-dev $(FONTS):fonts-dejavu-core); \
	echo 'int main(void) { return 0; }' >build/try.c; blas='-lblas -llapack'; \
	cholmod='$(ALONE)'; $(CC) build/try.c -o build/try $$cholmod $$blas -lm \
	  2>/dev/null || { blas='$(LAPACK)'; cholmod=$$(pkg-config --libs CHOLMOD || \
	  echo -L/usr/local/lib -L/opt/homebrew/lib -lcholmod) 2>/dev/null; }; \
	{ echo "DEP_CFLAGS := $(SUITESPARSE) \
	  $$(pkg-config --cflags sdl2 freetype2 libpng)"; \
	  echo "DEP_LIBS := $(if $(filter Darwin,$(shell uname)),,-Wl,--as-needed) $$cholmod \
	  $$(pkg-config --libs sdl2 freetype2 libpng) -lm"; \
	  echo "BLAS_LIBS := $$blas"; } >$@.new; mv $@.new $@

build/config-test.mk: build/config.mk
	@$(call need,cmocka:libcmocka-dev); \
	echo "TEST_LIBS := $$(pkg-config --libs cmocka)" >$@

# ---- programs --------------------------------------------------------------
# build/ has a copy of the program that was made last, with or without sanitizers.
build/elasto build/lecture build/elasto-bench: build/%: $(B)/% FORCE
	@cmp -s $< $@ || cp -f $< $@
build/stress: $(B)/stress-tests FORCE
	@cmp -s $< $@ || cp -f $< $@

# All rooms are one archive, made again when the list of its members changes.
# Objects are made again when the compiler or its flags change.
$(B)/members: text = $(OBJECTS)
$(B)/flags: text = $(COMPILE) $(DEP_LIBS)
$(B)/members $(B)/flags: FORCE
	@mkdir -p $(@D); echo '$(text)' | cmp -s - $@ || echo '$(text)' >$@

$(LIBRARY): $(OBJECTS) $(B)/members
	$(Q)rm -f $@; $(AR) rcs $@ $(OBJECTS)

# lecture.c is linked without the rooms.  It needs LAPACK and a full BLAS.
$(B)/lecture $(B)/elasto-bench $(B)/stress-tests $(B)/tests/%: \
  LIBS = $(TEST_LIBS) $(BLAS_LIBS)
$(B)/lecture: $(B)/lecture.o
$(B)/elasto: $(B)/main.o $(LIBRARY)
$(B)/elasto-bench: $(call objects,src/bench/*.c) $(LIBRARY)
$(B)/stress-tests: $(B)/tests/stress/stress.o $(STRESS) \
                   $(B)/tests/unit/testing.o $(LIBRARY)
$(B)/lecture $(B)/elasto $(B)/elasto-bench $(B)/stress-tests: $(B)/flags
	$(call shown,LINK)
	$(Q)$(LINK)

# The compiler vectorises the loops over the square's grid.
GRID_LOOPS = grid_energy tiles v_cycle
$(GRID_LOOPS:%=$(B)/solve/%.o): private CFLAGS := \
    $(CFLAGS:-O2=-O3) -fno-trapping-math -fno-math-errno

$(B)/%.o: src/%.c $(B)/flags
	$(call shown,CC)
	$(Q)$(COMPILE) -MMD -MP -c $< -o $@

# The benchmark's tables name the flags of the compiler.
$(B)/bench/%.o: private CPPFLAGS += -DBENCH_FLAGS='"$(strip $(CFLAGS))"'

-include $(wildcard $(B)/*.d $(B)/*/*.d $(B)/tests/*/*.d)

# ---- texts ------------------------------------------------------------------
# The pages of the tour, the functions that they show, and the cards are compiled
# into the program.
PAGES = src/lesson/pages.txt
CARDS = src/picture/cards.txt
READ = awk -f src/lesson/text.awk
LISTED = $(sort $(shell sed -n 's/^code \([^ ]*\).*/\1/p' $(PAGES)))

$(B)/texts.c: $(LISTED) $(PAGES) $(CARDS) $(wildcard src/*/*.awk) Makefile
	$(call shown,WRITE)
	$(Q){ echo '#include "lesson/pages.h"'; \
	  $(READ) -f src/lesson/code.awk -f src/lesson/pages.awk $(PAGES); \
	  pages=$$?; $(READ) -f src/picture/cards.awk $(CARDS) && [ $$pages = 0 ]; \
	  } >$@.new && mv $@.new $@

$(B)/texts.o: $(B)/texts.c $(B)/flags
	$(call shown,CC)
	$(Q)$(COMPILE) -MMD -MP -c $< -o $@

include tests/tests.mk src/web/web.mk

# ---- homework --------------------------------------------------------------
# homework.c is lecture.c with eleven functions to write.  An existing file is kept.
homework:
	@[ ! -e homework.c ] || { echo 'homework.c exists already: rename it first'; exit 1; }
	@awk -f src/homework/write.awk src/homework/tasks.txt src/lecture.c \
	  >homework.c && echo homework.c

FILE = homework.c
check-homework:
	@[ -f '$(FILE)' ] && set -- '$(FILE)' || set -- $(FILE); \
	  CC='$(CC)' DEP_CFLAGS='$(DEP_CFLAGS)' LIBS='$(DEP_LIBS) $(BLAS_LIBS)' \
	  sh src/homework/check.sh "$$@"

# ---- benchmark, installation, help -----------------------------------------
# A table replaces the last one only when it is complete.  The exit code of a pipe
# is that of tee, so the program's success is a file, `whole`.
bench: TABLES = work steps
bench: build/elasto-bench
	@mkdir -p build/bench; cd build/bench && for table in $(TABLES); do \
	  rm -f whole; \
	  { ../elasto-bench $$table $(ARGS) && : >whole; } | tee $$table.csv.part; \
	  [ -e whole ] || { rm -f $$table.csv.part; exit 1; }; \
	  mv $$table.csv.part $$table.csv && rm whole || exit 1; \
	done

figures:
	gnuplot -c src/bench/figures.gnuplot build/bench tests/data

install: build/elasto
	install -d '$(DESTDIR)$(PREFIX)/bin'
	install -m 755 build/elasto '$(DESTDIR)$(PREFIX)/bin/elasto'

uninstall:
	rm -f '$(DESTDIR)$(PREFIX)/bin/elasto'

clean:
	rm -rf build

help:
	@echo 'make run             build and open the window (ARGS="--segments 16")'
	@echo 'make run-lecture     the same with src/lecture.c (ARGS="k=1e6")'
	@echo 'make test            build and run all tests, 1 to 3 minutes'
	@echo 'make long-test       all tests in all their variations'
	@echo 'make homework        write homework.c: lecture.c with functions to write'
	@echo 'make check-homework  check it, or FILE="a.c b.c"'
	@echo 'make web             write build/elasto.html: the program as one page'
	@echo 'make handout         print the lecture as build/handout.pdf (NOTES=1)'
	@echo 'make bench           measure run time against error and time a step'
	@echo '                     (TABLES=work or steps; ARGS=--quick)'
	@echo 'make figures         draw the figure of the benchmark'
	@echo 'make pictures        draw the pictures of the README again'
	@echo 'make stress          judge random scenes in more digits, half an hour'
	@echo 'make same-bits, mutants, analyse    see tests/README.md'
	@echo 'make install         into $$(DESTDIR)$$(PREFIX)/bin; make uninstall'
	@echo 'make clean           remove build/'
	@echo 'INSTALL=no only names missing packages; V=1 shows the commands.'
	@echo 'CC, CFLAGS, CPPFLAGS, LDFLAGS and LDLIBS are used as usual.'

.PHONY: all web test-web homework check-homework elasto lecture run run-lecture test long-test suites stress \
        same-bits mutants analyse pictures bench figures handout install \
        uninstall clean help FORCE
.DELETE_ON_ERROR:
.SECONDARY:
