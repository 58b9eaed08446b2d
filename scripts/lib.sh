# Sourced by the other scripts: where the checkout is, and how to speak and to fail.
# shellcheck shell=bash disable=SC2034  # its variables are used elsewhere

set -euo pipefail

root="$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)"

# "[setup] text" on standard output; the stage is the name of the running script.
say() { printf '[%s] %s\n' "${0##*/}" "$*"; }

# The same on standard error, then the end.
die() {
    printf '[%s] error: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# catkin writes interpreter lines (#!/path/python) and unquoted shell commands, so it cannot work under a path
# with a blank in it. A link without blanks then stands in for the checkout, everywhere.
case "$root" in
    *[[:space:]]*)
        alias_of_root="/tmp/nao_library-$(id -u)-$(printf '%s' "$root" | sha256sum | cut -c1-12)"
        [ -e "$alias_of_root" ] || ln -sfn -- "$root" "$alias_of_root" || die "cannot link $alias_of_root to $root"
        # /tmp belongs to everybody: a link that someone else laid is not followed.
        if [ ! -O "$alias_of_root/." ] || [ "$(readlink -- "$alias_of_root")" != "$root" ]; then
            die "$alias_of_root is in the way: it should be a link to $root"
        fi
        root="$alias_of_root"
        ;;
esac

ws="$root/.ws"
venv="$root/.venv"
packages=(nao_library_msgs nao_library_actions nao_library_modules nao_sim_bridge launch test)

# What the caller's shell says about Python (a pyenv build, a user site, another workspace) must not reach ours.
clean_python_environment() {
    unset PYTHONPATH PYTHONHOME PYTHONSTARTUP PYTHONEXECUTABLE VIRTUAL_ENV __PYVENV_LAUNCHER__
    export PYTHONNOUSERSITE=1
    # Many images forbid Python to keep bytecode: two dozen programs would then compile themselves at every launch.
    unset PYTHONDONTWRITEBYTECODE
}

# libqi keeps a machine id under $HOME, and without one under the current directory.
ensure_home() {
    if [ ! -d "${HOME:-}" ]; then
        export HOME="$ws/home"
        mkdir -p "$HOME"
    fi
}

# One writer at a time: two makes in one checkout would otherwise install and build into each other.
take_lock() {
    mkdir -p "$ws"
    exec 9>"$ws/lock"
    flock -n 9 || {
        say "waiting for another make in this checkout..."
        flock 9
    }
}

# other_workspaces LIST: the catkin workspaces in a list like CMAKE_PREFIX_PATH that are not this one, a line each.
other_workspaces() {
    local place
    while IFS= read -r -d: place; do
        case "$place" in "" | /usr | /opt/ros/* | "$ws"/devel | "$ws"/devel/*) continue ;; esac
        [ ! -e "$place/.catkin" ] || printf '%s\n' "$place"
    done <<<"$1:"
}

# append VARIABLE PLACE: at the end of a list with colons between, unless it is there already.
append() {
    case ":${!1:-}:" in
        *":$2:"*) ;;
        *) export "$1=${!1:+${!1}:}$2" ;;
    esac
}

# append_python WORKSPACE: its Python packages, messages among them, at the end of PYTHONPATH.
append_python() {
    local python
    for python in "$1"/lib/python3*/dist-packages; do
        [ ! -d "$python" ] || append PYTHONPATH "$python"
    done
}
