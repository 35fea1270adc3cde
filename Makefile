# SPDX-License-Identifier: GPL-3.0-or-later
#
# make                build/mesofit (also ./mesofit), build/libmesofit.a and build/libmesofit.so
# make install        program, library, headers, figures' scripts, man page and completions of bash, to
#                     PREFIX=/usr/local (or prefix, and DESTDIR)
# make docs           docs/reference.md and docs/python-reference.md, which tests compare with what they are made of
# make test           builds and passes all tests, in their short form (minutes)
# make ENGINES=1 …    those in which LAMMPS or GROMACS runs, too
# make check          unit, reference and command-line tests (minutes)
# make check-physics  laws and exact limits (minutes)
# make check-long     tests that have a longer form, in that (an hour)
# make MPI=1 …        the program shares a fit among the processes of an MPI job
# make check-mpi      such fits have the bits of a fit in one process
# make check-live     the live view, also in a browser (minutes)
# make check-stress   time steps, friction, tables, sizes and lengths beyond the ordinary; kills, a clock set
#                     back, a German locale (minutes)
# make check-python   the Python package, with pytest (Debian: python3-numpy, python3-pytest)
# make asan           unit and cli tests under address and undefined-behaviour sanitizers
# make fuzz           damaged files, SECONDS=600 of them: every reader (libFuzzer, needs clang), whole runs
# make tsan           tests of threads and a threaded simulation under the thread sanitizer
# make lint           formatting, static analysis, layers, names, licence lines, lengths
# make standard-set   fits the standard set by defaults: one table, one figure (an hour; runs/standard-set)
# make results RUN=runs/…   runs what the README there asks for, and writes numbers and figures into it
# make number NUMBER=0.3.0   the next release has this number (RELEASING.md)
# make release        source archive, wheel and Debian packages of what is committed, tried
# make site           the pages with search, in build/site/site; no link may be broken
# make bench          speed of the engine on this machine, to tests/bench/results
# make WERROR=1 …     warnings are errors
# make VERBOSE=1 …    shows the whole commands

MAKEFLAGS += --no-print-directory

BUILD   ?= build
AT       = $(if $(VERBOSE),,@)
PACKAGES = gsl libcjson nlopt expat
# Reads H5MD, if it is there; HDF5= builds without.
ifeq ($(origin HDF5),undefined)
HDF5    := $(firstword $(foreach name,hdf5 hdf5-serial,$(shell pkg-config --exists $(name) && echo $(name))))
endif
# No psabi: all functions of vectors are inlined, so how one would be passed does not matter.
# Read what gzip and zstd have compressed, likewise.
ifeq ($(origin ZLIB),undefined)
ZLIB    := $(shell pkg-config --exists zlib && echo zlib)
endif
ifeq ($(origin ZSTD),undefined)
ZSTD    := $(shell pkg-config --exists libzstd && echo libzstd)
endif
UNPACKED = $(ZLIB) $(ZSTD)
WARN     = -Wall -Wextra -Wshadow -Wpointer-arith -Wstrict-prototypes -Wmissing-prototypes \
           -Wvla -Wundef -Wno-psabi $(if $(WERROR),-Werror)
# No -ffast-math: NaN must stay visible. These two only drop errno and FP exception flags, which
# nothing here reads, and let sqrt and comparisons vectorise.
OPTIMISE = -O3 -fno-math-errno -fno-trapping-math -ffp-contract=fast
CFLAGS  ?= $(OPTIMISE) -g
# Hidden: the shared library shows what include/ declares, and calls inside it go straight.
override CFLAGS += -std=c11 -fPIC -fvisibility=hidden -D_POSIX_C_SOURCE=200809L -D_XOPEN_SOURCE=700 -fopenmp $(WARN) \
           -Iinclude -Isrc -MMD -MP $(shell pkg-config --cflags $(PACKAGES)) $(SANITIZE)
# As needed: HDF5 brings a dozen libraries along, and 10 ms at the start of what is linked with it.
LDLIBS  := $(shell pkg-config --libs $(PACKAGES)) -Wl,--as-needed $(if $(HDF5),$(shell pkg-config --libs $(HDF5))) \
           $(if $(strip $(UNPACKED)),$(shell pkg-config --libs $(UNPACKED))) -lm
override LDFLAGS += -fopenmp $(SANITIZE)

H5MD     = $(wildcard src/trajectory/format_h5md.c src/trajectory/h5md_*.c)
# The live view is built where libmicrohttpd and Chart.js are (Debian: libmicrohttpd-dev,
# libjs-chart.js). The program alone has it, the libraries do not.
CHART       ?= /usr/share/javascript/chart.js
HAS_LIVE    := $(if $(wildcard $(CHART)/chart.min.js),$(shell pkg-config --exists libmicrohttpd && echo yes))
LIVE_WITHOUT = $(if $(HAS_LIVE),src/live/live_server_none.c,src/live/live_server.c src/live/live_assets.c)
LIVE_LIBS   := $(if $(HAS_LIVE),$(shell pkg-config --libs libmicrohttpd))

# The program has MPI if it is wanted, the libraries never do (Debian: libopenmpi-dev).
MPICC     ?= mpicc
MPI_CFLAGS = $(shell $(MPICC) --showme:compile 2>/dev/null || $(MPICC) -compile_info | cut -d' ' -f2-)
MPI_LIBS   = $(shell $(MPICC) --showme:link 2>/dev/null || $(MPICC) -link_info | cut -d' ' -f2-)
RANKS      = $(BUILD)/src/base/ranks.o
$(RANKS): override CFLAGS += $(MPI_CFLAGS)

SOURCES  = $(filter-out src/base/ranks.c $(LIVE_WITHOUT) $(if $(HDF5),src/trajectory/format_h5md_without.c,$(H5MD)),$(wildcard src/*/*.c))
OBJECTS  = $(SOURCES:%.c=$(BUILD)/%.o)
$(H5MD:%.c=$(BUILD)/%.o) $(patsubst %,$(BUILD)/tests/unit/trajectory/%_h5md.o,test_trajectory test_topology test_forces): \
    override CFLAGS += $(if $(HDF5),$(shell pkg-config --cflags $(HDF5)))
$(BUILD)/src/trajectory/unpack.o $(BUILD)/tests/unit/trajectory/test_trajectory_packed.o: \
    override CFLAGS += $(if $(ZLIB),-DHAS_ZLIB) $(if $(ZSTD),-DHAS_ZSTD)
LIBRARY  = $(BUILD)/libmesofit.a
LIVE     = $(BUILD)/live.a
# In no archive of the build, so that a commit links what says its name anew, and no test.
NAMED    = $(BUILD)/src/base/version.o
OF_LIBRARY = $(filter-out $(BUILD)/src/app/% $(BUILD)/src/live/% $(NAMED),$(OBJECTS))
PROGRAM  = $(BUILD)/mesofit
VERSION := $(shell sed -n 's/^.define MESOFIT_VERSION "\(.*\)"/\1/p' include/mesofit.h)
SONAME   = libmesofit.so.$(word 1,$(subst ., ,$(VERSION)))
SHARED_LIBRARY = $(BUILD)/libmesofit.so.$(VERSION)
MAN_PAGE   = $(BUILD)/mesofit.1
COMPLETION = $(BUILD)/mesofit.bash

.PHONY: all docs check check-physics check-long check-stress asan tsan fuzz lint bench clean
all: $(PROGRAM) mesofit $(SHARED_LIBRARY) $(MAN_PAGE) $(COMPLETION)

mesofit: $(PROGRAM)
	ln -sf $(PROGRAM) $@

$(LIBRARY): $(OF_LIBRARY)
$(LIVE): $(filter $(BUILD)/src/live/%,$(OBJECTS))
$(LIBRARY) $(LIVE):
	@rm -f $@
	@echo "ar $@"
	$(AT)ar rcs $@ $^

# What this build calls itself, compiled again when that changes.
NAME = $(BUILD)/version
$(NAME): FORCE
	@mkdir -p $(@D); src/base/version.sh >$@.now && { cmp -s $@.now $@ || cp $@.now $@; }
$(NAMED): $(NAME)
$(NAMED): override CFLAGS += -DMESOFIT_BUILD='"$(shell cat $(NAME))"'

# No header of it reads trajectories, so that its users load no HDF5.
SHARED_OBJECTS = $(sort $(filter-out $(H5MD:%.c=$(BUILD)/%.o),$(OF_LIBRARY)) \
                 $(BUILD)/src/trajectory/format_h5md_without.o $(NAMED))
$(SHARED_LIBRARY): $(SHARED_OBJECTS) src/library/exports.map
	@echo "ld $@"
	$(AT)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,--no-undefined \
	    -Wl,--version-script=src/library/exports.map $(LDFLAGS) -o $@ $(filter %.o,$^) $(LDLIBS)
	@ln -sf $(@F) $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $(BUILD)/libmesofit.so

# The same for a wheel: what it needs lies beside it. The program has neither HDF5 nor the live view there.
WHEEL_LIBRARY = $(BUILD)/wheel/$(SONAME)
WHEEL_PROGRAM = $(BUILD)/wheel/mesofit
IN_WHEEL = -Wl,-rpath,'$$ORIGIN' -Wl,--disable-new-dtags -Wl,--strip-debug
$(WHEEL_LIBRARY): $(SHARED_OBJECTS) src/library/exports.map
	@mkdir -p $(@D)
	@echo "ld $@"
	$(AT)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,--no-undefined $(IN_WHEEL) \
	    -Wl,--version-script=src/library/exports.map $(LDFLAGS) -o $@ $(filter %.o,$^) $(LDLIBS)
$(WHEEL_PROGRAM): $(sort $(filter $(BUILD)/src/app/%,$(OBJECTS)) $(BUILD)/src/live/live_server_none.o \
    $(filter-out %/live_server.o %/live_assets.o,$(filter $(BUILD)/src/live/%,$(OBJECTS))) $(SHARED_OBJECTS))
	@mkdir -p $(@D)
	@echo "ld $@"
	$(AT)$(CC) $(IN_WHEEL) $(LDFLAGS) -o $@ $^ $(LDLIBS)
.PHONY: wheel-files
wheel-files: $(WHEEL_LIBRARY) $(WHEEL_PROGRAM)

OF_PROGRAM = $(filter $(BUILD)/src/app/%,$(OBJECTS)) $(NAMED) $(LIVE) $(LIBRARY)
WITH_MPI   = $(BUILD)/mpi/mesofit
# Whether the program is linked with MPI: it is linked again when that changes.
STAMP     = $(BUILD)/configuration
$(STAMP): FORCE
	@mkdir -p $(@D); echo 'MPI=$(MPI)' | cmp -s - $@ || echo 'MPI=$(MPI)' > $@
FORCE:
$(PROGRAM): $(if $(MPI),$(RANKS)) $(OF_PROGRAM) $(STAMP)
$(WITH_MPI): $(RANKS) $(OF_PROGRAM)
$(PROGRAM) $(WITH_MPI):
	@mkdir -p $(@D)
	@echo "ld $@"
	$(AT)$(CC) $(LDFLAGS) -o $@ $(filter-out $(STAMP),$^) $(LIVE_LIBS) $(if $(filter $(RANKS),$^),$(MPI_LIBS)) $(LDLIBS)

# The page's files, which the assembler takes from there.
$(BUILD)/src/live/live_assets.o: CFLAGS += -Wa,-Ishare/live,-I$(CHART)
$(BUILD)/src/live/live_assets.o: $(wildcard share/live/*) $(CHART)/chart.min.js

# What the program tells of itself, whole or not at all.
$(MAN_PAGE): $(PROGRAM)
	$(AT)$(PROGRAM) describe --format man >$@.partial && mv $@.partial $@

$(COMPLETION): $(PROGRAM)
	$(AT)$(PROGRAM) describe --format bash >$@.partial && mv $@.partial $@

PYTHON ?= /usr/bin/python3
docs: $(PROGRAM) $(SHARED_LIBRARY)
	$(PROGRAM) describe --format markdown >$(BUILD)/reference.md && mv $(BUILD)/reference.md docs
	MESOFIT_LIBRARY=$(abspath $(BUILD)/$(SONAME)) PYTHONDONTWRITEBYTECODE=1 $(PYTHON) python/reference.py \
	    >$(BUILD)/python-reference.md && mv $(BUILD)/python-reference.md docs

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	@echo "cc $<"
	$(AT)$(CC) $(CFLAGS) -c -o $@ $<

# Tests: one program a file; a test may use the helpers in tests/shared.
UNIT_WITHOUT = $(if $(HDF5),,%_h5md.c) $(if $(HAS_LIVE),,tests/unit/live/test_live_server.c)
UNIT      = $(patsubst %.c,$(BUILD)/%,$(filter-out $(UNIT_WITHOUT),$(wildcard tests/unit/*/test_*.c)))
REFERENCE = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/reference/test_*.c))
CLI       = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/cli/test_*.c))
PHYSICS   = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/physics/test_*.c))
STRESS    = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/stress/test_*.c))
SHARED    = $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/shared/*.c))
SHARED_ARCHIVE = $(BUILD)/tests/shared.a
# Those that take longest as a rule come first, so that no lane waits at the end.
TESTS     = $(PHYSICS) $(CLI) $(REFERENCE) $(UNIT)
# Those with cases that are long, or longer, where tests/shared/length.h says so.
LONG      = $(filter $(patsubst %.c,$(BUILD)/%,$(shell grep -l '"shared/length.h"' tests/*/test_*.c tests/unit/*/test_*.c)),$(TESTS))
.SECONDARY: $(TESTS:=.o) $(STRESS:=.o) $(SHARED)

$(SHARED_ARCHIVE): $(SHARED)
	@rm -f $@
	@echo "ar $@"
	$(AT)ar rcs $@ $^

# Without what debuggers read of the library, which is most of a program, nor is it written for what
# is linked so. Tests that run the program compute next to nothing themselves.
STRIP_TEST = $(if $(SANITIZE),,-Wl,--strip-debug)
$(TESTS) $(STRESS): CFLAGS += -Itests
$(TESTS:=.o) $(STRESS:=.o): CFLAGS += $(if $(SANITIZE),,-g0)
$(CLI:=.o): CFLAGS += -O1
$(filter $(BUILD)/tests/unit/live/%,$(UNIT)): $(LIVE)
$(TESTS) $(STRESS): %: %.o $(SHARED_ARCHIVE) $(LIBRARY) | $(NAMED)
	@echo "ld $@"
	$(AT)$(CC) $(LDFLAGS) $(STRIP_TEST) -o $@ $(filter %.o,$^) $(NAMED) $(SHARED_ARCHIVE) $(filter $(LIVE),$^) $(LIBRARY) -lcmocka $(if $(filter $(LIVE),$^),$(LIVE_LIBS)) $(LDLIBS)

.PHONY: test tests
tests: all $(TESTS)
test:
	$(MAKE) -j$(shell nproc) tests
	$(MAKE) check-install check-all

check: all $(UNIT) $(REFERENCE) $(CLI) check-install
	MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(CLI) $(REFERENCE) $(UNIT)

check-physics: all $(PHYSICS)
	MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(PHYSICS)

check-long: all $(LONG)
	LONG=yes ENGINES=1 MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(LONG)

# The live view: who looks changes nothing, and the page in a browser, if there is one (Debian:
# chromium, chromium-driver, python3-selenium).
.PHONY: check-live
check-live: all
	MESOFIT=$(abspath $(PROGRAM)) tests/tools/check_live.sh

# Fits among the processes of an MPI job, where there is one (Debian: libopenmpi-dev, openmpi-bin).
.PHONY: check-mpi
KILLS ?= 3
check-mpi: all $(if $(shell command -v $(MPICC)),$(WITH_MPI))
	tests/tools/check_mpi.sh $(PROGRAM) $(WITH_MPI) $(KILLS)

# The Python package over the shared library, beside the program.
.PHONY: check-python
check-python: all
	MESOFIT=$(abspath $(PROGRAM)) MESOFIT_LIBRARY=$(abspath $(BUILD)/$(SONAME)) PYTHONDONTWRITEBYTECODE=1 \
	    $(PYTHON) -m pytest -q -p no:cacheprovider python/tests

# Faults that are preloaded: a process is killed at one of its steps on the disk (tests/stress/test_kill.c), its
# clock is set back (test_clock.c).
KILL_HOOK  = $(BUILD)/tests/stress/hooks/kill_at.so
CLOCK_HOOK = $(BUILD)/tests/stress/hooks/clock_back.so
$(KILL_HOOK) $(CLOCK_HOOK): $(BUILD)/%.so: %.c
	@mkdir -p $(@D)
	@echo "cc $<"
	$(AT)$(CC) -std=c11 -O1 -fPIC -shared $(WARN) -o $@ $< -ldl

$(BUILD)/tests/stress/test_uploads: $(LIVE)
check-stress: all $(STRESS) $(KILL_HOOK) $(CLOCK_HOOK)
	$(MAKE) SECONDS=60 fuzz-programs
	KILL_HOOK=$(abspath $(KILL_HOOK)) CLOCK_HOOK=$(abspath $(CLOCK_HOOK)) MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(STRESS)

# Unit and cli tests: those of physics run the same code for longer.
SANITIZED = -O1 -g1 -fno-omit-frame-pointer
ASAN = $(MAKE) BUILD=build/asan SANITIZE="-fsanitize=address,undefined -fno-sanitize-recover=all" \
	    CFLAGS="$(SANITIZED)"
asan:
	$(ASAN) check-sanitized

# Fuzzing. The readers belong to a few layers, which clang builds anew; the rest is as it always is.
FUZZED  = $(filter $(addprefix src/,base/% curves/% io/% topologies/% scene/% targets/% defaults/% trajectory/%),$(SOURCES)) \
          src/system/composition.c \
          tests/fuzz/fuzz_readers.c
READERS = build/fuzz/readers
MUTATE  = build/fuzz/mutate
SECONDS ?= 600

fuzz: $(READERS) fuzz-programs
	tests/fuzz/readers.sh $(READERS) $$(($(SECONDS) / 2))

# Whole runs, half of the time.
.PHONY: fuzz-programs
fuzz-programs: $(MUTATE)
	$(ASAN) build/asan/mesofit
	tests/fuzz/programs.sh build/asan/mesofit $(MUTATE) $$(($(SECONDS) / 2))

$(READERS): $(LIBRARY)
	@command -v clang >/dev/null || { echo "make fuzz needs clang (Debian package clang)"; exit 1; }
	$(MAKE) BUILD=build/fuzz CC=clang SANITIZE="-fsanitize=address,undefined,fuzzer-no-link" \
	    CFLAGS="-O1 -g -Wno-unknown-warning-option -fopenmp=libgomp" $(FUZZED:%.c=build/fuzz/%.o)
	clang -fsanitize=address,undefined,fuzzer -o $@ $(FUZZED:%.c=build/fuzz/%.o) $(LIBRARY) -lgomp $(LDLIBS)

$(MUTATE): tests/fuzz/mutate.c Makefile
	@mkdir -p $(@D)
	$(AT)$(CC) -std=c11 -O2 $(WARN) -o $@ $<

# The sanitizer does not see how the threads of libgomp wait for each other, and would report all
# that they share. libomp has the entries of libgomp, and tells the sanitizer through archer: so
# GCC compiles, vector kernels and all, and libomp runs it (Debian: libomp-dev).
THREADED = $(addprefix $(BUILD)/tests/reference/,test_threads test_parts)
tsan:
	$(MAKE) BUILD=build/tsan SANITIZE="-fsanitize=thread" CFLAGS="$(SANITIZED)" check-threads
.PHONY: check-threads
check-threads: $(PROGRAM) $(THREADED)
	tests/tools/check_threads.sh $(PROGRAM) $(THREADED)

.PHONY: check-all check-sanitized
check-all: $(PROGRAM) $(TESTS)
	MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(TESTS)

# The tutorial's fits are long for sanitizers, and shorter ones see the same code.
check-sanitized: $(PROGRAM) $(UNIT) $(CLI)
	MESOFIT=$(abspath $(PROGRAM)) tests/tools/run_tests.sh $(filter-out %/test_tutorial,$(UNIT) $(CLI))

PREFIX ?= $(or $(prefix),/usr/local)
LIBDIR ?= $(PREFIX)/lib
.PHONY: install check-install
install: all
	install -d $(addprefix $(DESTDIR),$(PREFIX)/bin $(PREFIX)/include/mesofit $(LIBDIR)/pkgconfig \
	    $(addprefix $(PREFIX)/share/,mesofit/plots mesofit/lammps/debian/fmt man/man1 bash-completion/completions))
	install $(PROGRAM) $(DESTDIR)$(PREFIX)/bin
	install -m 644 include/mesofit.h $(DESTDIR)$(PREFIX)/include
	install -m 644 include/mesofit/*.h $(DESTDIR)$(PREFIX)/include/mesofit
	install -m 644 $(LIBRARY) $(SHARED_LIBRARY) $(DESTDIR)$(LIBDIR)
	ar rs $(DESTDIR)$(LIBDIR)/$(notdir $(LIBRARY)) $(NAMED)
	ln -sf $(notdir $(SHARED_LIBRARY)) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libmesofit.so
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|' mesofit.pc.in \
	    >$(DESTDIR)$(LIBDIR)/pkgconfig/mesofit.pc
	install -m 644 plots/*.gp $(DESTDIR)$(PREFIX)/share/mesofit/plots
	install -m 644 share/lammps/*.* $(DESTDIR)$(PREFIX)/share/mesofit/lammps
	install -m 644 share/lammps/debian/fmt/format.h $(DESTDIR)$(PREFIX)/share/mesofit/lammps/debian/fmt
	install -m 644 $(MAN_PAGE) $(DESTDIR)$(PREFIX)/share/man/man1
	install -m 644 $(COMPLETION) $(DESTDIR)$(PREFIX)/share/bash-completion/completions/mesofit

# Into a folder of the build's own, where the examples are built and run as a user's programs.
STAGE = $(abspath $(BUILD))/stage
check-install: all
	@rm -rf $(STAGE)
	$(MAKE) install PREFIX=$(STAGE) >/dev/null
	CC="$(CC)" tests/tools/check_install.sh $(STAGE) $(BUILD)

lint: $(LIBRARY) $(LIVE)
	tests/tools/lint.sh $(LIBRARY) $(LIVE)

# A release, and its number: RELEASING.md.
.PHONY: number release site
number:
	packaging/number.sh "$(NUMBER)"
release:
	packaging/release.sh
# The pages as a site (Debian: mkdocs-material, python3-nbconvert, python3-ipykernel, and what notebooks import).
site: all
	MESOFIT_LIBRARY=$(abspath $(BUILD)/$(SONAME)) PYTHONPATH=$(abspath python) PYTHONDONTWRITEBYTECODE=1 \
	    PYDEVD_DISABLE_FILE_VALIDATION=1 $(PYTHON) packaging/site.py $(BUILD)/site

.PHONY: standard-set
standard-set: $(PROGRAM)
	PROGRAM=$(abspath $(PROGRAM)) runs/standard-set/run.sh

.PHONY: results
results: $(PROGRAM)
	tests/tools/results.sh $(PROGRAM) $(or $(RUN),$(error RUN=runs/… says which))

bench: $(PROGRAM)
	tests/bench/run.sh $(PROGRAM)

clean:
	rm -rf build mesofit

-include $(OBJECTS:.o=.d) $(RANKS:.o=.d) $(TESTS:=.d) $(STRESS:=.d) $(SHARED:.o=.d) \
         $(BUILD)/tests/fuzz/fuzz_readers.d
