# install_packages WHAT PACKAGE... : with apt-get as root, else name them in one line and fail.
install_packages() {
    local what=$1
    shift
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        echo "Installing $what: $*"
        apt-get update -qq
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
    else
        echo "Missing $what; as root: apt-get install $*" >&2
        return 1
    fi
}
