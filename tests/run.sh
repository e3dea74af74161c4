#!/bin/sh
# Installs what the tests need, builds them and runs them all. What follows the name is for ctest: tests/run.sh -L cpu
set -eu
cd "$(dirname "$0")/.."
harness/setup.sh --tests
cmake --preset tests
cmake --build --preset tests
# An X server that is reset whenever its last window is closed refuses whoever comes at that moment.
exec xvfb-run -a -s "-screen 0 1280x1024x24 -nolisten tcp -noreset" ctest --preset tests "$@"
