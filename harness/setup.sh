#!/bin/sh
# Installs the packages of Debian 12 or 13 that building, packing and running Shadowbench need; does nothing where they are.
# With --tests also what the tests need; with --fuzz that, and clang with its libFuzzer for the preset `fuzz`.
set -eu

packages="
  cmake dpkg-dev file g++ git glslang-dev glslang-tools help2man ninja-build pkg-config python3-glad spirv-tools
  libcli11-dev libdeflate-dev libegl-dev libembree-dev libfmt-dev libfreetype-dev libgl-dev libglfw3-dev
  libglm-dev libgsl-dev libimgui-dev libmeshoptimizer-dev libnlopt-cxx-dev libopenimageio-dev libosmesa6-dev
  libpugixml-dev libspirv-cross-c-shared-dev libstb-dev libtbb-dev libtinygltf-dev libtinyobjloader-dev
  libtomlplusplus-dev libvulkan-dev libxxhash-dev nlohmann-json3-dev openimageio-tools
  fonts-dejavu-core libegl1 libegl-mesa0 libgl1-mesa-dri mesa-vulkan-drivers
"
tests="chromium clang-format gcovr groff-base libgmock-dev libgtest-dev python3-jsonschema
  slurm-wlm xauth xdotool xvfb"
# What runs the tests of the pages may have come from elsewhere, and Debian's packages would then be in its way.
command -v node >/dev/null || tests="$tests nodejs"
command -v npm >/dev/null || tests="$tests npm"
case "${1-}" in
  "") ;;
  --tests) packages="$packages $tests" ;;
  --fuzz) packages="$packages $tests clang llvm libclang-rt-dev" ;;
  *) echo "setup.sh: unknown argument '$1': use --tests, --fuzz, or none" >&2; exit 2 ;;
esac

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done

# Releases with Mesa 25.1 or later have no OSMesa: the program is then built without it, and draws through EGL.
drop_osmesa_where_it_is_gone() {
  [ -n "$(apt-cache madison libegl-dev)" ] || return 0  # no lists of packages yet
  [ -z "$(apt-cache madison libosmesa6-dev)" ] || return 0
  missing=$(echo "$missing" | sed 's/ libosmesa6-dev//')
}
drop_osmesa_where_it_is_gone
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: run as root, or install sudo; missing:$missing" >&2; exit 1; }
  as_root="sudo"
fi
$as_root apt-get update -q
drop_osmesa_where_it_is_gone
echo "setup.sh: installing$missing"
# shellcheck disable=SC2086  # the lists are words on purpose
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
