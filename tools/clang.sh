#!/usr/bin/env bash
# Build the kernels with clang, warnings as errors, and test them:
#   tools/clang.sh PYTHON release|address|thread
# release: as users build it. address: AddressSanitizer and UndefinedBehaviorSanitizer. thread: ThreadSanitizer.
set -euo pipefail
python=$(realpath -s "$1") kind=$2
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/clang-$kind
export PATH="$(dirname "$python"):$PATH"

newest_clang() {
    for version in 22 21 20 19 18 17 16; do command -v "clang++-$version" && return; done
    command -v clang++ || true
}
clang=$(newest_clang)
if [ -z "$clang" ] && command -v apt-get > /dev/null && [ "$(id -u)" = 0 ]; then
    echo 'Installing clang 19 from Debian'
    { apt-get update -qq && apt-get install -y -qq clang-19; } > build/clang-install.log 2>&1 || cat build/clang-install.log
    clang=$(newest_clang)
fi
[ -n "$clang" ] || { echo 'No clang++ here: the build with clang is skipped'; exit 0; }

libraries=$("$clang" -print-resource-dir)/lib/linux
case $kind in
    release) type=Release flags='' preload='' tests='-n auto --dist loadfile tests/python/elements tests/python/materials' ;;
    address)
        type=RelWithDebInfo flags='-fsanitize=address,undefined -fno-sanitize-recover=undefined -shared-libsan -g1'
        preload="$libraries/libclang_rt.asan-x86_64.so $("$clang" -print-file-name=libstdc++.so)"
        tests='tests/python/elements tests/python/materials tests/python/model tests/python/surfaces tests/python/solvers' ;;
    thread)
        type=RelWithDebInfo flags='-fsanitize=thread -shared-libsan -g1'
        preload="$libraries/libclang_rt.tsan-x86_64.so"
        tests='tests/python/test_threads.py tests/python/solvers/test_multifrontal_threads.py' ;;
    *) echo "the kind is release, address or thread, not $kind"; exit 2 ;;
esac

mkdir -p "$build"
log=$build/build.log
echo "Building with $("$clang" --version | head -n 1), $kind"
{ cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$type" -DCMAKE_CXX_COMPILER="$clang" -DCMAKE_CXX_FLAGS="$flags" \
    -DUMFORM_STRICT=ON -DUMFORM_BUILD_TESTS=ON -DPython_EXECUTABLE="$python" -Dnanobind_DIR="$(python -m nanobind --cmake_dir)" &&
    cmake --build "$build"; } > "$log" 2>&1 || { tail -n 60 "$log"; exit 1; }

# The sources of the package beside the extension of this build.
rm -rf "$build/package"
mkdir "$build/package"
cp -r src/umform book/src/umform_book "$build/package"
rm -f "$build"/package/umform/_core*.so
cp "$build"/_core*.so "$build/package/umform"

export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# Python and its libraries leak on purpose; a test asks for more memory than there is.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
export TSAN_OPTIONS=ignore_noninstrumented_modules=1:halt_on_error=1:die_after_fork=0
[ "$kind" != thread ] || export OMP_NUM_THREADS=4
LD_LIBRARY_PATH=$libraries ctest --test-dir "$build" --output-on-failure --no-tests=error > "$log" 2>&1 || { cat "$log"; exit 1; }
grep 'tests passed' "$log"
# shellcheck disable=SC2086
PYTHONPATH=$build/package LD_PRELOAD=$preload python -m pytest -q -p no:cacheprovider -m 'not long' --timeout 1800 $tests
