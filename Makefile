# Perigal: make [MODE=release|debug|asan|tsan] [V=1];  targets: all demo test test-long test-full stress random kills fresh fuzz mutate compilers lint doc accuracy fracture gallery bench install clean
MODE    ?= release
prefix  ?= /usr/local
CC      ?= gcc
THREADS ?= 0
JOBS    ?= $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),$(shell nproc))
T       ?=
SIZE    ?= full

# ---- nothing to change below this line -------------------------------------------------------------------------------
VERSION := 0.1.0
# One-way order of the folders, nested ones by their path (mechanics/bonds): a file sees its own folder and those to its left (doc/architecture.md).
ORDER   := base ranks scene/quantity scene discretization/kernel mechanics/material mechanics/criterion linalg linalg/preconditioner io/netcdf geometry/mesh io/mesh_files geometry/cloud/search geometry/cloud/body geometry/cloud geometry/cells crack crack/geometry discretization/approx discretization/integration mechanics/sums/terms mechanics/sums/lattice mechanics/sums/list mechanics/sums mechanics/model force mechanics/boundary mechanics/bonds mechanics/galerkin/weak_form mechanics/galerkin mechanics crack/fracture contact mechanics/symbol solve/run solve/system solve/breaking solve/contact solve/growth solve/newmark solve/events solve/explicit solve io/output io/picture app/compare app/results scene/keys app/compare/stored app/plan app/session app/study app/cli/preparation app/cli/plots app/cli

PACKAGES := gcc libc6-dev make python3 pkg-config libyaml-dev libudunits2-dev libsuitesparse-dev libopenblas-pthread-dev \
            libgsl-dev libfftw3-dev libnetcdf-dev libcairo2-dev libqhull-dev libcmocka-dev
# What the tests of perigal-mpi, matlab-compat and python need; where these cannot be had, those tests say that they are skipped.
OPTIONAL := petsc-dev mpi-default-dev mpi-default-bin octave octave-netcdf octave-dev gnuplot-nox ghostscript fonts-freefont-otf python3-numpy python3-netcdf4

BUILD   := build/$(MODE)
# the threaded parts are what the thread sanitizer is for
THREADED := base mechanics/sums mechanics/force
# most tests compute little themselves: those of other folders than these compile in half the time
COSTLY   := linalg mechanics/sums mechanics/force contact io/picture
# what make compilers builds and runs
PORTABLE := base discretization/kernel mechanics/material mechanics/criterion linalg discretization/approx discretization/integration mechanics/sums mechanics/force solve
T       := $(or $(T),$(if $(filter tsan,$(MODE)),$(THREADED)))
# What every run loads when it starts; --as-needed: only those that are called directly.
LIBS    := -Wl,--as-needed -lfftw3 -lyaml -ludunits2 -lm -lpthread -ldl
# of the tests alone: references by another library, the checks
TESTLIBS := -lgsl -lcmocka -lcairo -lnetcdf -lopenblas
# Libraries that are loaded when they are needed (base/library.c): the SONAME of the one whose header is compiled with.
soname   = -DPG_$(1)_FILE='"$(shell readelf -d "$$($(CC) -print-file-name=lib$(2).so)" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')"'
STD     := -std=c17 -D_POSIX_C_SOURCE=200809L -D_XOPEN_SOURCE=700 -DPG_VERSION='"$(VERSION)"'
WARN    := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
INCLUDE := -Iinclude -Isrc -I/usr/include/suitesparse -I/usr/include/udunits2 -I/usr/include/cairo
OPT_release := -O2 -ftree-vectorize
OPT_of_tests = $(if $(filter release,$(MODE)),$(if $(filter $(COSTLY:%=$(BUILD)/test/%/%),$@),-O1,-O0) $(EXTRA_CFLAGS))
OPT_debug   := -Og -g -DPG_DEBUG
OPT_fuzz    := -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
OPT_mutate  := -O2 -w
OPT_tsan    := -O1 -g -fsanitize=thread -fno-omit-frame-pointer
OPT_asan    := -O1 -g -DPG_DEBUG -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
LINK    ?= static
# the shared library shows what include/perigal declares; tests that take the shared one (make mutate) call inner functions
VISIBLE := $(if $(filter shared,$(LINK)),default,hidden)
# -ffp-contract=off: machines with and without FMA round alike
CFLAGS  := $(STD) $(OPT_$(MODE)) -ffp-contract=off -fno-math-errno -fPIC -fvisibility=$(VISIBLE) $(WARN) $(INCLUDE) $(EXTRA_CFLAGS)
comma   := ,
LDFLAGS := $(if $(filter asan,$(MODE)),-fsanitize=address$(comma)undefined) $(if $(filter tsan,$(MODE)),-fsanitize=thread) $(EXTRA_LDFLAGS)
SECONDS ?= 60
FUZZ    ?= scene points expression mesh table result checkpoint
FUZZ_BUILD ?= build/fuzz

ALL     := $(sort $(shell find src -name '*.c'))
CLI     := $(filter src/app/cli/%,$(ALL))
MPISRC  := $(filter src/app/mpi/%,$(ALL))
SOURCES := $(filter-out $(CLI) $(MPISRC) src/app/convert/%,$(ALL))
TESTS   := $(sort $(shell find test -name 'test_*.c'))
TOOLS   := $(wildcard bench/*.c)
OBJECTS := $(SOURCES:src/%.c=$(BUILD)/src/%.o)
CLIOBJ  := $(CLI:src/%.c=$(BUILD)/src/%.o)
TESTBIN := $(TESTS:test/%.c=$(BUILD)/test/%)
# tests that replace a function of the C library, which the other tests of their folder must not see
ALONE   := $(BUILD)/test/io/output/test_interrupted $(BUILD)/test/app/results/test_durable $(BUILD)/test/app/results/test_killed $(BUILD)/test/scene/test_locale
BENCHBIN:= $(TOOLS:bench/%.c=$(BUILD)/bench/%)
RANKSBIN = $(if $(PETSC),$(patsubst bench/%.c,$(BUILD)/bench/%,$(wildcard bench/ranks/*.c)))
LIB     := $(BUILD)/libperigal.a
SOLIB   := $(BUILD)/libperigal.so.0
PROGRAM := $(BUILD)/perigal
# LINK=shared: the program and the tests take the shared library, so that one changed file costs one compilation and one link (make mutate)
LINKED  := $(if $(filter shared,$(LINK)),-L$(BUILD) -lperigal,$(LIB))
BEHIND  := $(if $(filter shared,$(LINK)),| $(SOLIB),$(LIB))
# perigal-mesh: only where Gmsh's library is installed (libgmsh-dev); newer ones start with one argument more
GMSH    := $(wildcard /usr/include/gmshc.h)
CONVERT := $(if $(GMSH),$(BUILD)/perigal-mesh)
# perigal-mpi: only where MPI and PETSc are installed (petsc-dev mpi-default-dev mpi-default-bin)
PETSC   := $(shell pkg-config --exists PETSc mpi 2>/dev/null && echo PETSc mpi)
MPI     := $(if $(PETSC),$(BUILD)/perigal-mpi)
PETSCLIB = $(patsubst -l%,%,$(filter -lpetsc%,$(shell pkg-config --libs-only-l PETSc)))
MPIOBJ  := $(MPISRC:src/%.c=$(BUILD)/src/%.o)
Q       := $(if $(V),,@)
# compilations and tests at a time: as many as make was given with -j, else a core each
PARALLEL = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(JOBS))

all: perigal $(SOLIB) $(CONVERT) $(MPI) perigal.pc

perigal: $(PROGRAM)
	$(Q)ln -sf $(PROGRAM) perigal

$(BUILD)/src/%.o: src/%.c Makefile
	@mkdir -p $(@D)
	$(if $(V),,@echo "  CC   $<")
	$(Q)$(CC) $(CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/src/linalg/suitesparse.o: CFLAGS += $(call soname,BLAS,openblas) $(call soname,CHOLMOD,cholmod) $(call soname,UMFPACK,umfpack)
# the scenes of `perigal new`, as C
NEW     := $(sort $(wildcard data/new/*/*))
$(BUILD)/new_scenes.h: $(NEW) .ci/new_scenes Makefile
	@mkdir -p $(@D)
	$(Q).ci/new_scenes $(NEW) > $@.new && mv $@.new $@
$(BUILD)/src/app/cli/new.o: $(BUILD)/new_scenes.h
$(BUILD)/src/app/cli/new.o: CFLAGS += -I$(BUILD)
$(BUILD)/src/io/netcdf/library.o: CFLAGS += $(call soname,NETCDF,netcdf)
$(BUILD)/src/geometry/cloud/search/delaunay.o: CFLAGS += $(call soname,QHULL,qhull_r)
$(BUILD)/src/io/picture/cairo_calls.o: CFLAGS += $(call soname,CAIRO,cairo)

$(LIB): $(OBJECTS)
	$(if $(V),,@echo "  AR   $@")
	$(Q)rm -f $@ && ar rcs $@ $^

$(SOLIB): $(OBJECTS)
	$(if $(V),,@echo "  LD   $@")
	$(Q)$(CC) -shared -Wl,-soname,libperigal.so.0 $(LDFLAGS) $^ $(LIBS) -o $@
	$(Q)ln -sf libperigal.so.0 $(BUILD)/libperigal.so

$(PROGRAM): $(CLIOBJ) $(BEHIND)
	$(if $(V),,@echo "  LD   $@")
	$(Q)$(CC) $(LDFLAGS) $(CLIOBJ) $(LINKED) $(LIBS) -o $@

$(BUILD)/src/app/convert/%.o: CFLAGS += $(if $(shell grep -A3 '^GMSH_API void gmshInitialize' $(GMSH) /dev/null | grep -w run),-DGMSH_RUN)

$(BUILD)/perigal-mesh: $(BUILD)/src/app/convert/perigal_mesh.o $(LIB)
	$(if $(V),,@echo "  LD   $@")
	$(Q)$(CC) $(LDFLAGS) $^ -lgmsh $(LIBS) -o $@

# The tests of a folder are one program, which runs the test that it is called by (test/main.c): one link instead of one a test.
$(BUILD)/test/%.o: test/%.c Makefile
	@mkdir -p $(@D)
	$(if $(V),,@echo "  TEST $<")
	$(Q)$(CC) $(CFLAGS) $(OPT_of_tests) -Itest $(if $(filter $(@:.o=),$(ALONE)),,-Dmain=main_of_$(*F)) -MMD -MP -c $< -o $@

$(ALONE): %: %.o $(BEHIND)
	$(Q)$(CC) $< $(LDFLAGS) $(LINKED) $(LIBS) $(TESTLIBS) -o $@

# of a folder of test (1), its tests but those that stand alone (2)
define folder_tests
$(BUILD)/test/$(1)/tests: $(patsubst %,%.o,$(2)) test/main.c $(BEHIND)
	$$(if $$(V),,@echo "  LD   $$@")
	$$(Q)seen=$$$$(nm -A --defined-only -g $(patsubst %,%.o,$(2)) | grep ' T ' | grep -vE ' T (main_of_test|fuzz)_'); [ -z "$$$$seen" ] || \
	    { echo "the other tests of the folder see this function; make it static, or add the test to ALONE of the Makefile:"; echo "$$$$seen"; exit 1; } >&2
	$$(Q)$$(CC) $$(CFLAGS) -DTESTS="$(patsubst %,TEST (%),$(notdir $(2)))" test/main.c $(patsubst %,%.o,$(2)) $$(LDFLAGS) $$(LINKED) $$(LIBS) $$(TESTLIBS) -o $$@

$(2): $(BUILD)/test/$(1)/tests
	$$(Q)ln -sf tests $$@
endef
$(foreach f,$(sort $(patsubst test/%/,%,$(dir $(TESTS)))),$(eval $(call folder_tests,$(f),$(filter-out $(ALONE),$(patsubst %.c,$(BUILD)/%,$(wildcard test/$(f)/test_*.c))))))

$(BUILD)/bench/%: bench/%.c $(LIB)
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) -MMD -MP -MF $@.d $< $(LDFLAGS) $(LIB) $(LIBS) -o $@

# beside perigal-mpi, by MPI, PETSc and FFTW-MPI alone
$(BUILD)/bench/ranks/%: bench/ranks/%.c
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) $(shell pkg-config --cflags $(PETSC) | sed 's/-I/-isystem /g') -MMD -MP -MF $@.d $< $(LDFLAGS) -lfftw3_mpi $(shell pkg-config --libs $(PETSC)) $(LIBS) -o $@

$(BUILD)/src/app/mpi/%.o: CFLAGS += $(shell pkg-config --cflags $(PETSC) | sed 's/-I/-isystem /g')
$(BUILD)/src/app/mpi/petsc_library.o: CFLAGS += $(call soname,PETSC,$(PETSCLIB))
$(BUILD)/perigal-mpi: $(MPIOBJ) $(filter-out %/main.o,$(CLIOBJ)) $(LIB)
	$(if $(V),,@echo "  LD   $@")
	$(Q)$(CC) $(LDFLAGS) $^ $(shell pkg-config --libs mpi) $(LIBS) -o $@

perigal.pc: perigal.pc.in FORCE
	$(Q)sed -e 's|@prefix@|$(prefix)|' -e 's|@version@|$(VERSION)|' -e 's|@libs@|$(LIBS)|' $< > $@

# The compiled functions of matlab-compat. The library's threads live as long as the process, so that it must not be unloaded (nodelete).
# MEX=mex: by MATLAB's compiler, which takes its flags as arguments.
MEX     ?= mkoctfile --mex
MEXSRC  := $(wildcard matlab-compat/mex/*.c)
MEXOUT   = $(BUILD)/matlab/perigal_mex.$(if $(findstring mkoctfile,$(MEX)),mex,mexa64)
MEXC     = $(filter-out -g,$(OPT_$(MODE))) -std=c17 -D_POSIX_C_SOURCE=200809L -fPIC $(WARN)
MEXLD    = -Wl,-z,nodelete -Wl,--exclude-libs,ALL
MEXBY    = $(if $(findstring mkoctfile,$(MEX)),CFLAGS="$(MEXC)" LDFLAGS="$(MEXLD)" $(MEX) -o $@,$(MEX) CFLAGS='$$CFLAGS $(MEXC)' LDFLAGS='$$LDFLAGS $(MEXLD)' -output $@)
mex: $(MEXOUT)       ## the compiled functions of matlab-compat, for Octave (package octave-dev); MEX=mex: for MATLAB
	$(Q)ln -sf ../$< matlab-compat/

$(MEXOUT): $(MEXSRC) $(wildcard matlab-compat/mex/*.h) $(LIB)
	@command -v $(firstword $(MEX)) > /dev/null || { echo "make mex needs $(firstword $(MEX)): install the package octave-dev, or name another compiler by MEX=" >&2; exit 1; }
	@mkdir -p $(@D)
	$(if $(V),,@echo "  MEX  $@")
	$(Q)$(MEXBY) -Iinclude $(MEXSRC) $(LIB) -lfftw3 -lyaml -ludunits2

packages:            ## install the Debian packages that are missing
	$(Q).ci/packages $(PACKAGES)

test-packages: packages
	$(Q)$(if $(filter asan tsan,$(MODE)),,.ci/packages $(OPTIONAL) || echo "perigal: tests that need one of them will say that they are skipped" >&2)

demo: packages       ## install, build, run the Brazilian disk, leave pictures
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal
	$(Q)./perigal run data/disk_crack/scene.yaml -o out/demo --force --threads $(THREADS)

# in full size: test-long: those that have a larger one, but those that test/order keeps; test-full: these too
test test-long test-full: test-packages  ## everything; last line: N passed, N failed
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal $(if $(filter release,$(MODE)),$(SOLIB) $(if $(shell command -v mkoctfile),mex)) test-programs $(if $(filter test-long,$@),bench-programs)
	$(Q).ci/test $(BUILD) "$(T)" $(or $(filter-out test,$(@:test-%=%)),short) $(JOBS)

test-programs: $(PROGRAM) $(CONVERT) $(MPI) $(if $(T),$(filter $(T:%=$(BUILD)/test/%/%),$(TESTBIN)),$(TESTBIN))

fuzz:                ## random inputs for SECONDS each (FUZZ=scene: one of them); findings land in build/fuzz
	$(Q)command -v clang > /dev/null || { echo "make fuzz needs libFuzzer: install the Debian package clang"; exit 1; }
	$(Q)$(MAKE) --no-print-directory MODE=fuzz CC=clang BUILD=$(FUZZ_BUILD) $(FUZZ:%=$(FUZZ_BUILD)/test/fuzz/fuzz_%)
	$(Q).ci/fuzz $(FUZZ_BUILD) $(SECONDS) $(FUZZ)

$(BUILD)/test/fuzz/fuzz_%: test/fuzz/fuzz_%.c $(LIB)
	@mkdir -p $(@D)
	$(Q)$(CC) $(CFLAGS) -Itest -MMD -MP -MF $@.d $< -fsanitize=fuzzer,address,undefined $(LIB) $(LIBS) -o $@

mutate: packages     ## plants the bugs of test/mutate (T=folder: of one, PART=k/8: an eighth) one at a time in a copy and counts those that the tests find
	$(Q).ci/mutate $(if $(T),-f $(T)) $(if $(PART),-p $(PART)) $(if $(MUTANTS),-n $(MUTANTS)) -j $(JOBS)

stress: packages     ## conditions x methods, an hour on two cores; rows in out/stress/stress.csv (SIZE=short|long: a sample; PART=k/n, ONLY=text: a part)
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal $(MPI)
	$(Q)PART=$(PART) ONLY="$(ONLY)" test/stress/run $(BUILD) $(SIZE) $(JOBS)

random: packages     ## 2000 random scenes under invariants, 60 minutes on two cores (FROM=seed COUNT=n PART=k/n KIND=.. ONLY=..); goes on where it was broken off
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal $(MPI)
	$(Q)test/random/run $(BUILD) FROM=$(or $(FROM),1) COUNT=$(or $(COUNT),2000) JOBS=$(JOBS) PART=$(or $(PART),1/1) KIND=$(KIND) ONLY=$(ONLY)

kills: packages      ## 300 runs that are interrupted at any instant and resumed, 25 minutes (FROM=number COUNT=n PART=k/n KIND=..); goes on where it was broken off
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal $(MPI)
	$(Q)test/kills/run $(BUILD) FROM=$(or $(FROM),1) COUNT=$(or $(COUNT),300) JOBS=$(JOBS) PART=$(or $(PART),1/1) KIND=$(KIND)

fresh:               ## make demo and make test on a bare Debian in a folder (root, debootstrap)
	$(Q).ci/fresh

compilers: packages  ## gcc -O0, gcc -O3, clang, warnings being errors; the short tests with each
	$(Q).ci/compilers "$(or $(T),$(PORTABLE))" $(JOBS)

lint:                ## the house rules of doc/testing.md; make lint WHY=--why names every offence against those not met yet
	$(Q).ci/lint $(WHY) $(ORDER)
	$(Q)out=$$(.ci/mutate --list) || { echo "$$out"; exit 1; }

doc: perigal         ## doc/input.md, from the tables that check a scene
	$(Q)./perigal help --manual > doc/input.md.new && mv doc/input.md.new doc/input.md

bench: packages      ## measures the tables of doc/benchmarks.md with the spread of repeats and rewrites them (T="group group")
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal bench-programs
	$(Q)bench/run $(BUILD) $(if $(REPEAT),--repeat $(REPEAT)) $(T)

fracture: packages   ## grows cracks of known load and rewrites the tables of doc/accuracy*.md about them (T="group group": of some)
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal
	$(Q)bench/fracture $(BUILD) -j $(JOBS) $(T)

gallery: packages    ## laboratory specimens with cracks, drawn at random, beside finite elements (SEED=n COUNT=n KIND=name); needs gmsh and calculix-ccx
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal
	$(Q)bench/gallery $(BUILD) SEED=$(or $(SEED),1) COUNT=$(or $(COUNT),10) KIND=$(KIND) JOBS=$(JOBS)

accuracy: packages   ## measures the tables of doc/accuracy*.md and rewrites them (T="group group": of some)
	$(Q)$(MAKE) --no-print-directory $(PARALLEL) perigal bench-programs $(ACCURACY:%=$(BUILD)/test/%)
	$(Q)bench/accuracy $(BUILD) -j $(JOBS) $(T)

bench-programs: $(BENCHBIN) $(MPI) $(RANKSBIN)
# tests that print what doc/accuracy_tables.md shows
ACCURACY := geometry/cells/test_cut mechanics/force/test_estimate mechanics/force/test_rigid_motion scene_runs/test_disk scene_runs/test_incompressible scene_runs/test_mesh scene_runs/test_notch scene_runs/test_uncracked_disk

install: all
	install -d $(addprefix $(DESTDIR)$(prefix)/,bin lib/pkgconfig include/perigal share/doc/perigal/doc share/man/man1 share/bash-completion/completions)
	install -d $(addprefix $(DESTDIR)$(prefix)/share/perigal/python/,perigal examples)
	install $(PROGRAM) $(CONVERT) $(DESTDIR)$(prefix)/bin
	install -m 644 $(LIB) $(SOLIB) $(DESTDIR)$(prefix)/lib
	ln -sf libperigal.so.0 $(DESTDIR)$(prefix)/lib/libperigal.so
	install -m 644 perigal.pc $(DESTDIR)$(prefix)/lib/pkgconfig
	install -m 644 include/perigal.h $(DESTDIR)$(prefix)/include
	install -m 644 include/perigal/*.h $(DESTDIR)$(prefix)/include/perigal
	install -m 644 README.md COPYING $(DESTDIR)$(prefix)/share/doc/perigal
	install -m 644 doc/*.md doc/*.png $(DESTDIR)$(prefix)/share/doc/perigal/doc
	.ci/man $(PROGRAM) > $(DESTDIR)$(prefix)/share/man/man1/perigal.1
	.ci/completion $(PROGRAM) > $(DESTDIR)$(prefix)/share/bash-completion/completions/perigal
	$(PROGRAM) help --schema > $(DESTDIR)$(prefix)/share/perigal/scene.schema.json
	rm -rf $(addprefix $(DESTDIR)$(prefix)/share/perigal/,scenes matlab)
	cp -r data $(DESTDIR)$(prefix)/share/perigal/scenes
	cp -rL matlab-compat $(DESTDIR)$(prefix)/share/perigal/matlab
	install -m 644 python/pyproject.toml python/README.md $(DESTDIR)$(prefix)/share/perigal/python
	install -m 644 python/perigal/*.py $(DESTDIR)$(prefix)/share/perigal/python/perigal
	install -m 644 python/examples/* $(DESTDIR)$(prefix)/share/perigal/python/examples

clean:
	rm -rf build out perigal perigal.pc matlab-compat/perigal_mex.*

FORCE:

print-%:
	@echo '$($*)'

.PHONY: FORCE all perigal mex packages test-packages demo test test-long test-programs stress random kills fresh fuzz mutate compilers lint doc accuracy fracture gallery bench bench-programs install clean
.SECONDARY:
-include $(OBJECTS:.o=.d) $(CLIOBJ:.o=.d) $(BUILD)/src/app/convert/perigal_mesh.d $(MPIOBJ:.o=.d) $(TESTBIN:=.d) $(BENCHBIN:=.d)
