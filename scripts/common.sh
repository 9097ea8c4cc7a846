# Sourced by the other scripts: where the project lies, missing packages, builds.

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
# Objects built in one checkout serve another one.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1

step() { printf '\n== %s\n' "$*"; }

# install_missing PACKAGE…: apt-get what is not there yet; asks for root only then.
install_missing() {
    local missing=() package
    for package in "$@"; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local root=()
    [ "$(id -u)" -eq 0 ] || root=(sudo)
    step "installing ${missing[*]}"
    "${root[@]}" apt-get update -qq
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

install_packages() {
    local packages
    mapfile -t packages < <(grep -v '^#' scripts/packages.txt)
    install_missing "${packages[@]}"
}

# build PRESET [TARGET…]
build() {
    local preset=$1
    shift
    step "building $preset"
    cmake --preset "$preset" >build/configure-"$preset".log 2>&1 || { cat build/configure-"$preset".log; return 1; }
    cmake --build --preset "$preset" -j "$(nproc)" ${1:+--target "$@"}
}
