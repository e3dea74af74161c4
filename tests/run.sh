#!/bin/sh
# Installs what the tests need, builds them and runs them all. What follows the name is for ctest: tests/run.sh -L cpu
set -eu
cd "$(dirname "$0")/.."
harness/setup.sh --tests
cmake --preset tests
cmake --build --preset tests
exec xvfb-run -a ctest --preset tests "$@"
