#!/bin/sh
# lint.odr: an object for one instruction set may define global or weak symbols only in its burnish::bn_<isa>. The linker keeps one copy of
# a weak symbol (an inline function, a std:: template) for the whole program. A copy made for AVX-512 would crash other processors, and a
# scalar copy would silently serve all.
# usage: odr.sh isa_list.h build-folder   all objects in <target>_<isa>.dir; skips sanitizer builds
#        odr.sh isa_list.h isa object
if ! command -v nm >/dev/null 2>&1; then
    echo "skipped: no nm here"
    exit 77
fi
[ $# -gt 1 ] || { echo "usage: odr.sh isa_list.h build-folder | odr.sh isa_list.h isa object" >&2; exit 2; }
isas=$(sed -n 's/^ .*\bX(\([a-z0-9]*\), .*of).*/\1/p' "$1")
[ -n "$isas" ] || { echo "no instruction sets in $1"; exit 1; }
shift

# Upper-case kinds are global; u, v and w are unique or weak. DW.ref.* are the unwinder's pointers and hold no instructions.
leaks_of() { # OBJECT ISA
    nm --defined-only "$1" | awk 'NF >= 2 { print $(NF - 1), $NF }' | grep -E '^[A-Zuvw] ' |
        grep -vE "^. (_Z[A-Z]*7burnish$((${#2} + 3))bn_$2|DW\.ref\.)"
}

status=0
checked=0
check() { # OBJECT ISA
    checked=$((checked + 1))
    [ -r "$1" ] || { echo "cannot read $1"; status=1; return; }
    leaks=$(leaks_of "$1" "$2")
    [ -z "$leaks" ] && return
    echo "$1 defines symbols outside burnish::bn_$2:"
    printf '%s\n' "$leaks" | c++filt | sed 's/^/    /'
    status=1
}

if [ ! -d "$1" ]; then
    check "$2" "$1"
elif grep -q '^BN_SANITIZE:[^=]*=.' "$1/CMakeCache.txt" 2>/dev/null; then
    echo "passed over: sanitizers add symbols of their own"
    exit 0
else
    for isa in $isas; do
        for object in $(find "$1" -path "*_$isa.dir/*.o"); do
            check "$object" "$isa"
        done
    done
fi
[ "$checked" -gt 0 ] || { echo "no objects of bn_isa_objects found"; exit 1; }
echo "$checked objects checked"
exit $status
