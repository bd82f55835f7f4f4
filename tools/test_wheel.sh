#!/usr/bin/env bash
# Install a wheel into an environment of its own and use it as a user does, without a compiler and without the sources:
#   tools/test_wheel.sh PYTHON WHEEL FOLDER BOOK
# The wheel of the book is installed after umform has been used without it, since tests take problems of the book.
set -euo pipefail
python=$1 wheel=$(realpath "$2") environment=$3 book=$(realpath "$4")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")

"$python" -m venv --clear "$environment"
environment=$(realpath "$environment")
alone() { env -i HOME="$environment" PATH="$environment/bin" "$@"; }
alone python -m pip --disable-pip-version-check -q install --only-binary=:all: "$wheel" pytest pytest-timeout hypothesis
cd "$environment"
if alone python -m zipfile -l "$wheel" | grep -q umform_book; then
    echo "the wheel holds the verification book, a package of its own" && exit 1
fi
for compiler in cc c++ gcc g++ clang clang++; do
    if alone python -c "import shutil, sys; sys.exit(shutil.which('$compiler') is None)"; then
        echo "there is a compiler: $compiler" && exit 1
    fi
done
alone python -c "import umform, umform._core as core; print(umform.__file__, core.__file__, core.build(), sep='\n')"
alone umform demo free-bending --mesh 8x1 --out demo --overwrite > demo.log || { cat demo.log; exit 1; }
alone umform bend --thickness 2 --stroke 5 --elements-per-thickness 2 --out bend > bend.log || { cat bend.log; exit 1; }
ls demo/* bend/* > /dev/null
if alone umform verify 2> verify.log || ! grep -q 'pip install ./book' verify.log; then
    echo 'without the book, umform verify does not say how to get it' && cat verify.log && exit 1
fi
alone python -m pip --disable-pip-version-check -q install "$book"
alone umform verify > verify.log
cd "$root"
alone python -m pytest -q -p no:cacheprovider tests/python/elements tests/python/materials tests/python/test_reference.py
