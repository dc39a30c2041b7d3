# Installs what is missing of packages.txt. Sourced by apps/demo and tests/run; no other file names packages.
#   burnish_setup GROUP...     groups: build, test, wasm, cluster
# BURNISH_NO_INSTALL=1 skips it. Ends the calling script with code 2 where the packages cannot be installed.

burnish_packages() # GROUP...: their packages, one a line
{
    local list group package rest wanted
    list="$(dirname "${BASH_SOURCE[0]}")/packages.txt"
    while read -r group package rest; do
        for wanted in "$@"; do
            if [ "$group" = "$wanted" ]; then echo "$package"; fi
        done
    done < "$list"
}

burnish_is_debian()
{
    command -v apt-get > /dev/null && command -v dpkg-query > /dev/null || return 1
    (. /etc/os-release 2> /dev/null && [[ " ${ID:-} ${ID_LIKE:-} " =~ \ (debian|ubuntu)\  ]])
}

burnish_missing() # PACKAGE...: those that are not installed
{
    local installed package
    installed="$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2> /dev/null | sed -n 's/^installed //p')"
    for package in "$@"; do
        grep -qxF -- "$package" <<< "$installed" || echo "$package"
    done
}

burnish_apt_install() # PACKAGE...; as_root is the caller's: empty, or sudo
{
    local log
    log="$(mktemp)"
    # Hundreds of lines that nobody reads, unless it fails.
    if burnish_apt_install_aloud "$@" > "$log" 2>&1; then rm -f "$log"; return 0; fi
    tail -n 30 "$log" >&2
    rm -f "$log"
    return 1
}

burnish_apt_install_aloud() # PACKAGE...
{
    local install=(apt-get -q -o DPkg::Lock::Timeout=300 install -y --no-install-recommends "$@")
    local as=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive) try
    # Known to the lists that are there: no update needed.
    if apt-cache show "$@" > /dev/null 2>&1 && "${as[@]}" "${install[@]}"; then return 0; fi
    for try in 1 2; do
        if "${as[@]}" apt-get -q update && "${as[@]}" "${install[@]}"; then return 0; fi
        if [ "$try" = 1 ]; then
            echo "burnish: apt-get failed, one more try in 5 seconds" >&2
            sleep 5
        fi
    done
    return 1
}

burnish_setup() # GROUP...
{
    local packages missing command as_root=()
    if [ "${BURNISH_NO_INSTALL:-0}" = 1 ]; then return 0; fi
    packages=($(burnish_packages "$@"))
    if [ "${#packages[@]}" = 0 ]; then
        echo "burnish: no packages of the groups $* in apps/packages.txt" >&2
        exit 2
    fi
    if ! burnish_is_debian; then
        echo "burnish: this machine is not Debian: install what these Debian 12 packages hold, then set BURNISH_NO_INSTALL=1" >&2
        printf '  %s\n' "${packages[@]}" >&2
        exit 2
    fi
    missing=($(burnish_missing "${packages[@]}"))
    if [ "${#missing[@]}" = 0 ]; then return 0; fi
    command="apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    if [ "$(id -u)" != 0 ]; then
        # sudo may ask for a password, but only where somebody can answer.
        if command -v sudo > /dev/null && { sudo -n true 2> /dev/null || [ -t 0 ]; }; then
            as_root=(sudo)
        else
            echo "burnish: packages are missing, and installing them takes root. Run this as root, then try again:" >&2
            echo "  $command" >&2
            exit 2
        fi
    fi
    echo "Installing ${#missing[@]} packages, a minute or two: ${missing[*]}"
    if ! burnish_apt_install "${missing[@]}"; then
        echo "burnish: the packages could not be installed. By hand, as root: $command" >&2
        exit 2
    fi
}
