# All that is done to umform from a shell. A bare clone needs Python >= 3.11 with its headers, make and a
# C++20 compiler; the rest comes from PyPI into .venv. The package is installed as a user would install it
# (never editable), so what runs and what is tested is what is shipped; build/venv keeps the object files, so
# that a second install compiles only what changed.

PYTHON ?= python3
JOBS   ?= $(shell env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc 2>/dev/null || echo 2)
ARGS   ?=
JSON   ?= build/bench.json

VENV   := .venv
MPI    := .venv-mpi
BIN    := $(VENV)/bin
BUILD  := build/venv
PIP    := $(BIN)/python -m pip --disable-pip-version-check -q
SAY    := @printf '\033[1m==>\033[0m %s\n'

# Directories are listed too: their time changes when a file is removed.
PACKAGE   := $(shell find CMakeLists.txt pyproject.toml cpp src \
                 -not -name '*.pyc' -not -name '*.so' -not -name __pycache__)
BOOK      := $(shell find book/pyproject.toml book/README.md book/src -not -name '*.pyc' -not -name __pycache__)
CPP       := $(shell find cpp -name '*.hpp' -o -name '*.cpp')
CPP_TESTS := $(wildcard tests/cpp/*.hpp tests/cpp/*.cpp tests/cpp/*/*.hpp tests/cpp/*/*.cpp)

# Where each commit is checked, a warning of the compiler is an error; a newer compiler of a user's may warn.
STRICT := $(if $(CI),--config-settings=cmake.define.UMFORM_STRICT=ON)

export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
unexport PYTHONPATH PYTHONHOME PYTHONDONTWRITEBYTECODE

.NOTPARALLEL:
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help
.PHONY: k-factor help env book dev demo test test-cpp test-python test-long test-clang windows sanitize test-pardiso pardiso test-mpi mpi instructions verification mutants lint lint-others lint-python lint-workflows lint-once lint-imports lint-types lint-page lint-stubs lint-format lint-cpp stubs \
        format docs wheel bench bench-picture dome robust robust-draws balances bands ubend cup draws touch s-rail compare peers gallery clean

help:  ## show this help
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)
	@echo '  Variables: PYTHON=python3.12, JOBS=4, ARGS="-k contact" (handed to pytest and to the benchmarks)'

# ---- environment: four stamps, each made again only when what it depends on has changed ----
# A stamp bears the time at which its rule began, so that a file saved during the build counts as changed.

env: $(VENV)/.package  ## make .venv and install umform into it
book: $(VENV)/.book  ## the same, with the verification book
dev: $(VENV)/.book $(VENV)/.dev  ## the same, with the tools of the developers

$(VENV)/.tools: pyproject.toml tools/check_machine.py tools/requirements.py
	@$(PYTHON) tools/check_machine.py
	$(SAY) 'Making $(VENV) and fetching the build tools from PyPI'
	@$(BIN)/python -m pip --version > /dev/null 2>&1 || $(PYTHON) -m venv $(VENV)
	@$(BIN)/python tools/requirements.py build > $@.new
	@$(PIP) install -r $@.new
	@mv $@.new $@

# What umform needs at run time is fetched while umform is compiled. pip would write the bytecode of some 3000 files,
# which takes as long as to unpack them; umform imports a fifth of these: those that this line imports.
IMPORTED := import h5py._hl.base, matplotlib.figure, matplotlib.backends.backend_agg, matplotlib.backends.backend_svg, \
    rich.progress, scipy.sparse.linalg, typer.main, typer.rich_utils

$(VENV)/.package: $(VENV)/.tools $(PACKAGE)
	$(SAY) 'Compiling and installing umform with $(JOBS) jobs (a minute the first time)'
	@touch $@.new
	@$(BIN)/python tools/requirements.py run > $(VENV)/run.new
	@{ cmp -s $(VENV)/run.new $(VENV)/run || { $(PIP) install --no-compile -r $(VENV)/run.new \
	    && $(BIN)/python -c '$(IMPORTED)' && mv $(VENV)/run.new $(VENV)/run; }; } & fetched=$$!; \
	$(PIP) install --no-deps --no-build-isolation --config-settings=build-dir=$(BUILD) $(STRICT) .; built=$$?; \
	wait $$fetched && exit $$built
	@mv $@.new $@

# A package of its own, without compiled code; what it needs comes with umform.
$(VENV)/.book: $(VENV)/.package $(BOOK)
	$(SAY) 'Installing the verification book'
	@touch $@.new
	@$(PIP) install --no-deps --no-build-isolation ./book
	@mv $@.new $@

$(VENV)/.dev: $(VENV)/.tools
	$(SAY) 'Fetching the tools of the developers from PyPI'
	@$(BIN)/python tools/requirements.py run dev > $@.new
	@$(PIP) install -r $@.new
	@mv $@.new $@

# ---- run ----

demo: env  ## bend a strip over a cylinder; pictures and report in results/free-bending
	$(SAY) 'Running the demo'
	@$(BIN)/umform demo free-bending --out results/free-bending --overwrite

bench: env  ## time kernels, a run and the sparse solvers; the numbers go to build/bench.json, or JSON=file
	@$(BIN)/python benchmarks/kernels.py --json $(JSON) $(ARGS)
	@$(BIN)/python benchmarks/run.py --json $(JSON)
	@$(BIN)/python benchmarks/sparse.py --json $(JSON)

dome: env  ## a sphere pressed into sheets of up to 160 000 elements: time, memory, evaluations thrown away (an hour)
	@$(BIN)/python benchmarks/dome.py --json build/dome.json --plot docs/images/dome.png --page docs/performance-increments.md $(ARGS)
	@$(BIN)/python tools/performance_numbers.py

balances: env  ## 63 jobs of all kinds whose balances are watched (a minute of CPU); writes docs/balances.md
	@$(BIN)/python benchmarks/balances.py --json build/balances.json --page docs/balances.md $(ARGS)

bands: env  ## studies of errors, for the bands of numbers (some 70 minutes of CPU, less what benchmarks/bands.jsonl has); writes docs/bands.md
	@$(BIN)/python benchmarks/bands.py --page docs/bands.md $(ARGS)

robust: env  ## 300 random jobs and how many finish (some 10 minutes of CPU), then the balances; writes docs/robust-rate.md
	@$(BIN)/python benchmarks/robust.py --json build/robust.json --page docs/robust-rate.md $(ARGS)
	@$(BIN)/python tools/performance_numbers.py
	@$(MAKE) balances ARGS=

robust-draws: env  ## 200 random jobs of drawing and forming (some 12 minutes of CPU); writes docs/robust-draws.md
	@$(BIN)/python benchmarks/robust.py --lot draws --json build/robust.json --page docs/robust-draws.md $(ARGS)

ubend: book  ## a U-bend with friction, beside CalculiX if it is there (a quarter of an hour)
	$(SAY) 'Drawing the U-bend'
	@$(BIN)/python benchmarks/ubend.py --page docs/performance-codes.md $(ARGS)
	@$(BIN)/python tools/performance_numbers.py

cup: book  ## the cup of the ESAFORM benchmark 2021, and an isotropic one, on four meshes each (a minute and a half of CPU)
	$(SAY) 'Drawing the cup'
	@$(BIN)/python benchmarks/esaform_cup.py --json build/cup.json --page docs/performance-increments.md $(ARGS)

draws: book  ## what drawn cups and U-bends cost, and what their evaluations are for (some ten minutes)
	$(SAY) 'Drawing cups and U-bends'
	@$(BIN)/python benchmarks/draws.py --json build/draws.json --page docs/performance-draws.md $(ARGS)
	@$(BIN)/python benchmarks/beside.py --json build/beside.json --page docs/performance-draws.md

touch: env  ## what contact of sheets costs: search, couplings, factors (some three minutes of CPU)
	@$(BIN)/python benchmarks/sheets_that_touch.py --json build/touch.json --page docs/performance-contact.md $(ARGS)
	@$(BIN)/python benchmarks/sheets_that_touch.py --search --page docs/performance-contact.md
	@$(BIN)/python benchmarks/couplings_of_sheets.py --page docs/performance-contact.md

s-rail: book  ## the S-rail of the verification book with up to 6 000 elements, three penalties (an hour)
	$(SAY) 'Drawing the S-rail'
	@$(BIN)/python benchmarks/s_rail.py --json build/s_rail.json $(ARGS)

k-factor: env  ## K over radius / thickness from runs, for docs/k-factor.md (75 s of CPU the first time)
	@$(BIN)/python tools/k_factor_picture.py $(ARGS)

bench-picture: dev  ## the page of the bench with a finished bend, for docs/bench.md; needs Chromium
	@$(BIN)/python tools/bench_picture.py $(ARGS)

compare: env  ## compare the speed of two commits: make compare ARGS="main HEAD"
	@$(BIN)/python benchmarks/compare.py $(ARGS)

peers: book  ## the same work in other codes that are installed, CalculiX first (some 15 minutes of CPU)
	@$(BIN)/python benchmarks/peers/run.py --out benchmarks/peers/results.md --page docs/performance-codes.md $(ARGS)
	@$(BIN)/python tools/performance_numbers.py

gallery: book $(VENV)/.dev  ## pictures of formed parts and docs/gallery.md (some 4 minutes of CPU the first time)
	$(SAY) 'Drawing the gallery'
	@$(BIN)/python benchmarks/gallery.py $(ARGS)

# ---- test ----

test: $(if $(wildcard tests/cpp/CMakeLists.txt),test-cpp) test-python  ## all tests but the long ones

test-cpp: env  ## tests of the kernels alone
	$(SAY) 'Testing the kernels'
	@$(BIN)/cmake -DUMFORM_BUILD_TESTS=ON $(BUILD) > $(BUILD)/tests.log || { cat $(BUILD)/tests.log; exit 1; }
	@$(BIN)/cmake --build $(BUILD) > $(BUILD)/tests.log || { cat $(BUILD)/tests.log; exit 1; }
	@$(BIN)/ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -j $(JOBS) > $(BUILD)/tests.log \
	    || { cat $(BUILD)/tests.log; exit 1; }
	@grep 'tests passed' $(BUILD)/tests.log

test-python: dev  ## tests of the installed package
	$(SAY) 'Testing the installed package'
	@OMP_NUM_THREADS=1 $(BIN)/python tools/run_tests.py -n $(JOBS) $(ARGS)

test-long: dev  ## the long verification runs
	@$(BIN)/pytest -q -m long $(ARGS)

test-clang: dev  ## build the kernels with clang, warnings as errors, and test them (skipped without clang)
	$(SAY) 'Testing a build by clang'
	@bash tools/clang.sh $(BIN)/python release

windows: $(VENV)/.tools  ## cross-compile the kernels for Windows with mingw and test them with wine (skipped without mingw)
	$(SAY) 'Testing a build for Windows'
	@bash tools/windows.sh $(BIN)

mutants: dev  ## put small errors into a copy, each of which a test must notice: make mutants ARGS="Free springs"
	$(SAY) 'Trying the mutants of tests/mutants.toml'
	@$(BIN)/python tools/mutants.py $(ARGS)

sanitize: dev  ## tests with clang's sanitizers: addresses, undefined behaviour, threads (an hour)
	$(SAY) 'Testing with AddressSanitizer and UndefinedBehaviorSanitizer'
	@bash tools/clang.sh $(BIN)/python address
	$(SAY) 'Testing with ThreadSanitizer'
	@bash tools/clang.sh $(BIN)/python thread

BENDING := tests/verification/test_free_bending.py
PARDISO_TESTS := tests/python/solvers tests/python/test_threads.py '$(BENDING)::test_forces_of_the_table[12x1 MI9K3DEAS 3]' \
    $(BENDING)::test_threads_beside_pardiso_give_the_same_bits

# The extra goes into .venv: .ci/run calls this after `make test`.
pardiso: dev  ## put MKL (the extra "pardiso", some 700 MB) into .venv; "make clean" takes it out again
	$(SAY) 'Putting MKL (the extra "pardiso", some 700 MB) into $(VENV); "make clean" takes it out again'
	@$(BIN)/python tools/requirements.py pardiso > $(BUILD)/pardiso.txt
	@$(PIP) install -r $(BUILD)/pardiso.txt > $(BUILD)/pardiso.log 2>&1 || { \
	    grep -q 'No matching distribution' $(BUILD)/pardiso.log && ! grep -q Retrying $(BUILD)/pardiso.log; } \
	    || { cat $(BUILD)/pardiso.log; exit 1; }

test-pardiso: pardiso  ## tests of solvers, threads and a bend with PARDISO
	@if $(PIP) show mkl > /dev/null 2>&1; then \
	    printf '\033[1m==>\033[0m %s\n' 'Testing with PARDISO: solvers, threads, free bending of 12 x 1 elements with 18 nodes' && \
	    $(BIN)/python -c 'import umform.solvers as s; raise SystemExit(0 if s.available()["pardiso"] else "MKL is not found")' && \
	    OMP_NUM_THREADS=1 $(BIN)/pytest -q -n $(JOBS) --dist loadfile $(PARDISO_TESTS) $(ARGS); \
	else echo 'There is no wheel of MKL for this platform: PARDISO is not tested here'; fi

# Beside .venv, never in it: Debian's petsc4py wants NumPy 1.
$(MPI)/.made: pyproject.toml tools/mpi_environment.py tools/requirements.py | $(VENV)/.package
	$(SAY) 'Making $(MPI): PETSc and MPI from Debian (apt-get, if they are missing), the rest from PyPI'
	@$(BIN)/python tools/mpi_environment.py $(MPI) \
	    "$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')/umform"
	@touch $@

mpi: env $(MPI)/.made  ## make .venv-mpi, which runs umform on many ranks

test-mpi: mpi  ## tests on 1, 2 and 3 ranks with PETSc
	$(SAY) 'Testing on 1, 2 and 3 ranks with PETSc'
	@$(MPI)/bin/python -m pytest -q tests/mpi --timeout 900 $(ARGS)

verification: pardiso  ## run the whole verification book and write docs/verification (long)
	$(SAY) 'Running all cases of the verification book'
	@$(BIN)/umform verify --all --out docs/verification $(ARGS)
	@$(if $(ARGS),,$(BIN)/python tools/readme_numbers.py)

instructions: env  ## instructions of the kernels against the stored counts (skipped without valgrind)
	$(SAY) 'Counting the instructions of the kernels'
	@$(BIN)/python benchmarks/instructions.py $(ARGS)

# ---- documentation ----

DOCS    := build/docs
VERSION  = $(shell $(BIN)/python -c 'import umform; print(umform.__version__)')
NETWORK := <(script|link|img|iframe|source)[^>]* (src|href)="(https?:)?//

$(VENV)/.docs: $(VENV)/.tools
	$(SAY) 'Fetching the tools of the site from PyPI'
	@$(BIN)/python tools/requirements.py docs > $@.new
	@$(PIP) install -r $@.new
	@mv $@.new $@

docs: env $(VENV)/.docs  ## the documentation as a site in build/docs; every warning is an error
	$(SAY) 'Making the site in $(DOCS)/$(VERSION) (some 2 minutes of CPU the first time)'
	@rm -rf docs/site/api/generated
	@mkdir -p build; ls docs/site/api > build/docs-pages.new  # Sphinx misses new pages of the API in an old cache
	@cmp -s build/docs-pages.new build/docs-pages || { rm -rf build/docs-cache; mv build/docs-pages.new build/docs-pages; }
	@$(BIN)/sphinx-build -q -W --keep-going -c docs/site -d build/docs-cache docs $(DOCS)/$(VERSION) $(ARGS)
	@! grep -rlE --include='*.html' '$(NETWORK)' $(DOCS)/$(VERSION) || { echo 'these pages load something from a network'; exit 1; }
	@! grep -rlE --include='*.css' 'url\(["'"'"']?(https?:)?//' $(DOCS)/$(VERSION) || { echo 'these styles load something from a network'; exit 1; }
	@$(BIN)/python tools/check_site.py $(DOCS)/$(VERSION)
	@echo 'Open $(DOCS)/index.html, or serve it: python3 -m http.server -d $(DOCS)'

# ---- wheel ----

$(VENV)/.wheel: $(VENV)/.tools
	$(SAY) 'Fetching the tools of wheels from PyPI'
	@$(BIN)/python tools/requirements.py wheel > $@.new
	@$(PIP) install -r $@.new
	@mv $@.new $@

wheel: env $(VENV)/.wheel  ## wheels of umform and of the book in dist, tested in an environment without a compiler
	$(SAY) 'Making the wheel'
	@rm -rf build/wheel
	@$(PIP) wheel --no-deps --no-build-isolation --config-settings=build-dir=$(BUILD) -w build/wheel .
	@$(PIP) wheel --no-deps --no-build-isolation -w dist ./book
	@PATH="$(abspath $(BIN)):$$PATH" $(BIN)/auditwheel repair -w dist build/wheel/*.whl > build/wheel/repair.log 2>&1 \
	    || { cat build/wheel/repair.log; exit 1; }
	$(SAY) 'Testing it in build/wheel/env, whose PATH has no compiler'
	@bash tools/test_wheel.sh $(PYTHON) "$$(ls -t dist/umform-*.whl | head -1)" build/wheel/env \
	    "$$(ls -t dist/umform_book-*.whl | head -1)"

# ---- style ----

lint: lint-others lint-cpp  ## style, types and names, in Python and in C++
lint-others: lint-python lint-workflows lint-once lint-imports lint-types lint-page lint-stubs lint-format  ## all of lint but clang-tidy

lint-python: $(VENV)/.dev
	$(SAY) 'ruff'
	@$(BIN)/ruff check -q .
	@$(BIN)/ruff format -q --check . || { echo "run 'make format' on the files that 'ruff format --check .' names"; exit 1; }

# The package of PyPI fetches a binary of a forge; Go compiles the sources.
ACTIONLINT := $(abspath build/actionlint)

lint-workflows:
	$(SAY) 'workflows of the forge'
	@if [ -x $(ACTIONLINT)/actionlint ] || { command -v go > /dev/null && mkdir -p $(ACTIONLINT) && \
	    GOBIN=$(ACTIONLINT) go install github.com/rhysd/actionlint/cmd/actionlint@v1.7.12 > build/actionlint.log 2>&1; }; \
	then $(ACTIONLINT)/actionlint; \
	else echo 'no Go, or actionlint cannot be fetched: the workflows of the forge are not checked'; fi

lint-once: $(VENV)/.dev
	$(SAY) 'defaults and bounds that are stated twice'
	@$(BIN)/python tools/said_once.py

lint-imports: $(VENV)/.dev
	$(SAY) 'direction of imports'
	@PYTHONPATH=src:book/src $(BIN)/lint-imports --no-cache --no-logo > $(VENV)/imports.log || { cat $(VENV)/imports.log; exit 1; }

lint-types: $(VENV)/.dev
	$(SAY) 'mypy'
	@$(BIN)/mypy --no-error-summary

# The types of the page stand in comments; TypeScript comes from npm, where there is one.
TSC := npx --yes -p typescript@5.9 tsc

lint-page:
	$(SAY) 'types of the page'
	@if ! $(TSC) --version > /dev/null 2>&1; then echo 'no npx, or TypeScript cannot be fetched: the types of the page are not checked'; \
	else $(TSC) -p src/umform/bench/page/jsconfig.json; fi

STUBGEN := $(BIN)/python -m nanobind.stubgen -q -m umform._core -p cpp/bindings/stub_pattern.txt

lint-stubs: dev
	$(SAY) 'stubs of the kernels'
	@$(STUBGEN) -o $(BUILD)/_core.pyi
	@cmp -s $(BUILD)/_core.pyi src/umform/_core.pyi || { echo "the bindings have changed: run 'make stubs'"; exit 1; }

stubs: dev  ## write src/umform/_core.pyi anew from the bindings
	@$(STUBGEN) -o src/umform/_core.pyi

lint-format: $(VENV)/.dev
	$(SAY) 'clang-format'
	@$(BIN)/clang-format --dry-run --Werror $(CPP) $(CPP_TESTS)

# Each header is parsed on its own, so it must include what it uses.
lint-cpp: $(VENV)/.dev
	$(SAY) 'clang-tidy'
	@includes="$$($(BIN)/python tools/includes.py)" && printf '%s\n' $(CPP) | xargs -P $(JOBS) -I {} \
	    $(BIN)/clang-tidy --quiet {} -- -x c++ -std=c++20 -Icpp/include $$includes

format: $(VENV)/.dev  ## put Python and C++ into the style of the house
	@$(BIN)/ruff check -q --fix . || true
	@$(BIN)/ruff format -q .
	@$(BIN)/clang-format -i $(CPP) $(CPP_TESTS)

clean:  ## remove what make has made, but not results/
	rm -rf $(VENV) $(MPI) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
