#!/bin/sh
# Installs the Debian 12 packages that building, testing and running Shadowbench need; does nothing where they are.
# With --fuzz also clang and its libFuzzer, for the preset `fuzz`.
set -eu

packages="
  cmake g++ git ninja-build pkg-config python3-glad
  libbenchmark-dev libcli11-dev libegl-dev libembree-dev libfmt-dev libfreetype-dev libgl-dev libglfw3-dev libglm-dev libgmock-dev libgsl-dev libgtest-dev
  libnlopt-cxx-dev libopenimageio-dev libosmesa6-dev libpugixml-dev libtbb-dev libtinygltf-dev libtinyobjloader-dev libtomlplusplus-dev nlohmann-json3-dev
  fonts-dejavu-core gcovr gnuplot-nox libjs-chart.js openimageio-tools libegl1 libegl-mesa0 libgl1-mesa-dri python3-jsonschema xauth xvfb
"
case "${1-}" in
  "") ;;
  --fuzz) packages="$packages clang llvm libclang-rt-14-dev" ;;
  *) echo "setup.sh: unknown argument '$1': use --fuzz, or none" >&2; exit 2 ;;
esac

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: run as root, or install sudo; missing:$missing" >&2; exit 1; }
  as_root="sudo"
fi
echo "setup.sh: installing$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086  # the lists are words on purpose
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
