#!/bin/bash
# Installs the Debian packages that are missing, saying what each is for. Usage: setup/apt.sh [test|bench|cost]
set -euo pipefail

packages=(
    "g++|compiles the native library"
    "cmake|configures its build"
    "ninja-build|runs its build"
    "libosmesa6-dev|OpenGL in software, without a display or a GPU"
    "libegl-dev|OpenGL on a GPU without a display"
    "libglfw3-dev|OpenGL in a window"
    "libgl-dev|OpenGL's headers"
    "glslang-dev|the GLSL compiler that SHADERed uses too"
    "glslang-tools|without it glslang's build files refuse to load"
    "spirv-tools|linked by glslang"
    "libassimp-dev|reads models, as SHADERed does"
    "zlib1g-dev|linked by Assimp"
    "python3-venv|keeps Python's packages in .venv"
)
if [ "${1:-}" = test ] || [ "${1:-}" = bench ]; then
    packages+=("libgl1-mesa-dri|the driver under EGL and windows, to compare with")
fi
if [ "${1:-}" = test ]; then
    packages+=("xvfb|a display for the windows of tests" "xauth|lets programs onto it"
        "xdotool|moves the mouse and types there")
fi
if [ "${1:-}" = cost ]; then
    packages+=("libvulkan-dev|asks a driver what it compiles" "mesa-vulkan-drivers|compiles for GPUs that are not there")
fi

missing=()
for entry in "${packages[@]}"; do
    name=${entry%%|*}
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" != installed ]; then
        [ ${#missing[@]} -gt 0 ] || echo "These Debian packages are missing and will be installed:"
        printf '  %-16s %s\n' "$name" "${entry#*|}"
        missing+=("$name")
    fi
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "Not root, and no sudo: as root, run: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q >/dev/null
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}" >/dev/null
