#!/bin/sh
# lint.odr: an object compiled for one instruction set may define global or weak symbols only in burnish::bn_<isa>. The linker
# keeps one copy of a weak symbol (an inline function, a std:: template) for the whole program: a copy made for AVX-512 would
# crash other processors, a scalar copy would silently serve all.
# usage: odr.sh object-or-build-folder...    (in a folder: the objects of bn_isa_objects; sanitizer builds are passed over)
if ! command -v nm >/dev/null 2>&1; then
    echo "skipped: no nm here"
    exit 77
fi
[ $# -gt 0 ] || { echo "usage: odr.sh object-or-build-folder..." >&2; exit 2; }

# Upper-case kinds are global; u, v and w are unique or weak. DW.ref.* are the unwinder's pointers: no instructions in them.
leaks_of() {
    nm --defined-only "$1" | awk 'NF >= 2 { print $(NF - 1), $NF }' | grep -E '^[A-Zuvw] ' |
        grep -vE '^. (_Z[A-Z]*7burnish(9bn_scalar|7bn_avx2|9bn_avx512|9bn_double|10bn_counted)|DW\.ref\.)'
}

status=0
checked=0
check() {
    checked=$((checked + 1))
    [ -r "$1" ] || { echo "cannot read $1"; status=1; return; }
    leaks=$(leaks_of "$1")
    [ -z "$leaks" ] && return
    echo "$1 defines symbols outside burnish::bn_*:"
    printf '%s\n' "$leaks" | c++filt | sed 's/^/    /'
    status=1
}

for argument in "$@"; do
    if [ ! -d "$argument" ]; then
        check "$argument"
        continue
    fi
    if grep -q '^BN_SANITIZE:[^=]*=.' "$argument/CMakeCache.txt" 2>/dev/null; then
        echo "passed over: sanitizers add symbols of their own"
        exit 0
    fi
    for object in $(find "$argument" -regex '.*_\(scalar\|avx2\|avx512\|double\|counted\)\.dir/.*\.o'); do
        check "$object"
    done
done
[ "$checked" -gt 0 ] || { echo "no objects of bn_isa_objects found"; exit 1; }
echo "$checked objects checked"
exit $status
