#!/usr/bin/env bash
# Cross-compile the kernels and their tests for Windows with mingw-w64, warnings as errors, and run the tests with wine:
#   tools/windows.sh BIN, the folder of CMake and ninja
set -euo pipefail
bin=$(realpath -s "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/windows
mkdir -p "$build"
log=$build/build.log
compiler=x86_64-w64-mingw32-g++-posix
wine() { PATH="$PATH:/usr/lib/wine" command -v wine64 || command -v wine; }

if { ! command -v $compiler || ! wine; } > /dev/null && command -v apt-get > /dev/null && [ "$(id -u)" = 0 ]; then
    echo 'Installing mingw-w64 and wine from Debian'
    { apt-get update -qq && apt-get install -y -qq --no-install-recommends g++-mingw-w64-x86-64-posix wine64; } > "$log" 2>&1 || cat "$log"
fi
command -v $compiler > /dev/null || { echo "No $compiler here: the build for Windows is skipped"; exit 0; }

echo "Building with $($compiler --version | head -n 1)"
{ "$bin/cmake" -S . -B "$build" -G Ninja -DCMAKE_MAKE_PROGRAM="$bin/ninja" -DCMAKE_TOOLCHAIN_FILE="$PWD/tools/mingw.cmake" \
    -DCMAKE_BUILD_TYPE=Release -DUMFORM_STRICT=ON -DUMFORM_BUILD_MODULE=OFF -DUMFORM_BUILD_TESTS=ON &&
    "$bin/cmake" --build "$build"; } > "$log" 2>&1 || { tail -n 60 "$log"; exit 1; }
wine > /dev/null || { echo 'No wine here: what was built for Windows does not run'; exit 0; }

# A prefix of its own, outside the tree: it has a link to the root, which the makers of source packages would follow. Wine makes it before the tests, which would all wait for it. The libraries are those of the compiler.
libraries=
for name in libstdc++-6.dll libwinpthread-1.dll; do
    libraries+="Z:$(dirname "$(realpath "$($compiler -print-file-name=$name)")");"
done
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
export WINEPATH=$libraries WINEPREFIX=$prefix WINEDEBUG=-all OMP_NUM_THREADS=2
PATH="$PATH:/usr/lib/wine" "$(basename "$(wine)")" cmd /c exit > /dev/null 2>&1 || true
"$bin/ctest" --test-dir "$build" --output-on-failure --no-tests=error -j "${CMAKE_BUILD_PARALLEL_LEVEL:-1}" > "$log" 2>&1 \
    || { cat "$log"; exit 1; }
grep 'tests passed' "$log"
