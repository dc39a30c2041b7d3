#!/bin/sh
# lint.format: every C++ source and header, kernels included, follows .clang-format.
# usage: format.sh ROOT    exit 77: no clang-format 14 (other versions format differently)
cd "$1" || exit 2
tool=
for name in clang-format-14 clang-format; do
    if command -v "$name" >/dev/null 2>&1 && "$name" --version | grep -q 'version 14\.'; then
        tool=$name
        break
    fi
done
[ -n "$tool" ] || { echo "skipped: no clang-format 14 here"; exit 77; }
files=$(find core shading raster apps tests bench \( -name '*.h' -o -name '*.cpp' \) -type f)
[ -n "$files" ] || { echo "no sources below $1"; exit 1; }
# shellcheck disable=SC2086
"$tool" --dry-run -Werror --ferror-limit=1 $files || { echo "to put it right: $tool -i FILE..."; exit 1; }
echo "$(echo "$files" | wc -l) files"
