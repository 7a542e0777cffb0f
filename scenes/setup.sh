# shellcheck shell=bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by scenes/demo and tests/run: functions that take Debian 12 or 13 from nothing to a built program and the
# demo's mesh and environment. Finished steps cost no time. Exit codes are the program's: 2 when the user has something
# to do first, 3 when a step failed. The output of apt and of the build goes to a log.
set -euo pipefail

root=$(dirname "$(dirname "$(realpath "${BASH_SOURCE[0]}")")")

# Only what no other package of the list brings along; OpenImageIO's CMake targets do not load without its tools.
# The lists are for the scripts that source this file.
# shellcheck disable=SC2034
build_packages=(g++ cmake ninja-build libembree-dev libcgal-dev libopenmesh-dev libopenexr-dev libpng-dev
  libopenimageio-dev openimageio-tools libtbb-dev nlohmann-json3-dev libcli11-dev libfmt-dev libhdf5-dev libxxhash-dev
  libpugixml-dev libdraco-dev libmeshoptimizer-dev libboost-dev libmurmurhash-dev libjs-chart.js help2man)
# The pages of the view and of reports are tested in a browser, 98 MB to fetch and 300 MB on the disk.
# shellcheck disable=SC2034
test_packages=(libgtest-dev parallel clang-format chromium-headless-shell python3-jsonschema python3-dev python3-venv)
# Assets by many programs, some of them broken on purpose: 21 MB to fetch and 74 MB on the disk. Slurm and munge are
# for the templates of farms, the others for Blender.
# shellcheck disable=SC2034
long_test_packages=(assimp-testmodels slurm-wlm munge libvulkan1 libxrender1 libxi6 libxkbcommon0 libsm6 libgl1 libegl1
  libxxf86vm1 libxfixes3)

log=$root/scenes/out/${0##*/}.log
mkdir -p "${log%/*}"
: >"$log"
upgrade=no # whether installed packages may be upgraded: --upgrade

say() { printf 'opaline: %s\n' "$*"; }
note() { say "$*" >>"$log"; }

fail() {
  local code=$1
  shift
  say "$*" >&2
  exit "$code"
}

# Runs a command with its output in the log, whose end is shown where the command fails.
logged() {
  local code=0
  "$@" >>"$log" 2>&1 || code=$?
  ((code == 0)) || {
    tail -n 25 "$log" >&2
    say "the lines above end the log $log" >&2
  }
  return "$code"
}

# Never asks: not by debconf, not about configuration files, not on standard input. Waits for another apt to end.
# Downloads as root when root: apt's own user may not write where the mesh goes.
apt_get() {
  DEBIAN_FRONTEND=noninteractive apt-get -y -o APT::Sandbox::User=root -o Acquire::Retries=3 \
    -o DPkg::Lock::Timeout=300 -o Dpkg::Options::=--force-confdef -o Dpkg::Options::=--force-confold "$@" </dev/null
}

is_installed() {
  dpkg-query --show --showformat='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
}

# The installed packages that apt would upgrade or remove on the way.
# in    what follows apt-get
changed_by() { apt_get --simulate "$@" 2>/dev/null | sed -n 's/^\(Inst\|Remv\) \([^ ]*\) \[.*/\2/p'; }

# Names of those that are not installed.
missing_packages() {
  local package
  for package in "$@"; do is_installed "$package" || echo "$package"; done
}

install_packages() {
  local missing changed
  [[ -n $(type -P apt-get) ]] ||
    fail 2 "this script sets up Debian 12 and 13; elsewhere install the libraries of $*, then use cmake"
  readarray -t missing < <(missing_packages "$@")
  ((${#missing[@]} > 0)) || return 0

  local install=(install --no-install-recommends "${missing[@]}")
  ((EUID == 0)) || fail 2 "packages are missing, run: sudo apt-get update && sudo apt-get ${install[*]}"
  note "installing from Debian: ${missing[*]}"
  logged apt_get update || say "apt-get update failed for some sources, going on with what is known" >&2
  readarray -t changed < <(changed_by "${install[@]}")
  if ((${#changed[@]} > 0)) && [[ $upgrade == no ]]; then
    fail 2 "the missing packages need newer versions of installed ones: ${changed[*]}; nothing was installed;" \
      "to let apt upgrade these, add --upgrade"
  fi
  logged apt_get "${install[@]}" || fail 3 "could not install ${missing[*]}; is the network there?"
}

# A file of a Debian package that is not installed, into scenes/assets/. In a subshell, so that the trap and the folder
# are its own.
# in    the package, how much of it is fetched, the file's path in it, its sha256
fetch() (
  package=$1 size=$2 path=$3 sha256=$4
  file=$root/scenes/assets/${path##*/}
  is_right() { [[ -f $1 ]] && sha256sum --status --check <<<"$sha256  $1"; }
  if is_right "$file"; then exit 0; fi
  note "fetching scenes/assets/${file##*/} from Debian's package $package ($size, not installed)"
  mkdir -p "${file%/*}"
  scratch=$(mktemp -d "${file%/*}/fetch.XXXXXX") # beside the file, so that mv is atomic
  trap 'rm -rf "$scratch"' EXIT
  cd "$scratch"
  if ! apt_get -q download "$package" >>"$log" 2>&1; then
    ((EUID == 0)) || fail 2 "$package could not be fetched; with the network there, run: sudo apt-get update"
    apt_get update >>"$log" 2>&1 || true
    logged apt_get -q download "$package" || fail 3 "$package could not be fetched; is the network there?"
  fi
  dpkg-deb --fsys-tarfile "$package"_*.deb | tar -xO "$path" >fetched
  is_right fetched || fail 3 "${file##*/} of $package is not the one the scenes were made for (sha256)"
  mv -f fetched "$file"
)

fetch_bunny() {
  fetch glmark2-data "6.6 MB" ./usr/share/glmark2/models/bunny.obj \
    bff773d28c62e80187b2dfa8c6c8cc771a4c7707ddcdcf2e515913d322d1f548
}

# A file of an archive that is a file of a Debian package, as fetch.
# in    as fetch, then the archive's path in the package and its sha256
fetch_packed() (
  package=$1 size=$2 path=$3 sha256=$4 archive=$5 archive_sha256=$6
  file=$root/scenes/assets/${path##*/}
  is_right() { [[ -f $1 ]] && sha256sum --status --check <<<"$sha256  $1"; }
  if is_right "$file"; then exit 0; fi
  packed=$root/scenes/assets/${archive##*/}
  fetch "$package" "$size" "$archive" "$archive_sha256"
  tar -xzOf "$packed" "$path" >"$file.tmp"
  is_right "$file.tmp" || fail 3 "${file##*/} of $package is not the one the scenes were made for (sha256)"
  mv -f "$file.tmp" "$file"
  rm -f "$packed"
)

fetch_mannequin() {
  fetch_packed libcgal-demo "24 MB" data/meshes/mannequin-devil.off \
    9424b7132b58766984051fb7757543e88972f91fe7e9565d4e5b715b204f74a5 ./usr/share/doc/libcgal-dev/data.tar.gz \
    027b0920ebb9d396e8b99704f84ce7a417e37c364bea87a2b24bdeab02df76ab
}

# An independent path tracer, for the slow tests that compare with it; they are skipped where it cannot be had.
fetch_mitsuba() {
  local folder=$root/build-mitsuba
  [[ ! -e $folder/done ]] || return 0
  say "fetching Mitsuba from PyPI (80 MB)"
  if python3 -m venv "$folder" && "$folder/bin/python3" -m pip install --quiet mitsuba==3.6.4 numpy; then
    touch "$folder/done"
  else
    say "Mitsuba cannot be had from PyPI: the tests against it are skipped" >&2
    rm -rf "$folder"
  fi
}

# For the Python package and its tests; the same holds. --long: with the libraries of its examples, and of USD files (29 MB).
fetch_python() {
  local folder=$root/build-python packages=(nanobind numpy pytest)
  [[ ${1:-} != --long ]] || packages+=(scipy matplotlib usd-core)
  [[ ! -e $folder/done${1:-} ]] || return 0
  say "fetching ${packages[*]} from PyPI"
  local is_new=no
  [[ -e $folder/done ]] || is_new=yes
  if python3 -m venv "$folder" && "$folder/bin/python3" -m pip install --quiet "${packages[@]}"; then
    touch "$folder/done${1:-}"
  else
    say "${packages[*]} cannot be had from PyPI: what needs them is not tested" >&2
    [[ $is_new == no ]] || rm -rf "$folder"
  fi
}

# The program that writes many of the .glb files there are, for the slow tests that read one; the same holds.
# bpy 4.5 and 5.0 are for Python 3.11, Debian 12's.
# in    a version, then the name of its folder
fetch_blender() {
  local folder=$root/$2
  [[ ! -e $folder/done ]] || return 0
  say "fetching Blender $1 from PyPI (400 MB)"
  if python3 -m venv "$folder" && "$folder/bin/python3" -m pip install --quiet "bpy~=$1.0" &&
    "$folder/bin/python3" -c 'import bpy'; then
    touch "$folder/done"
  else
    say "Blender cannot be had from PyPI: the tests against it are skipped" >&2
    rm -rf "$folder"
  fi
}

# Checks and runs the templates of Open Job Description; the same holds.
fetch_openjd() {
  local folder=$root/build-openjd
  [[ ! -e $folder/done ]] || return 0
  say "fetching openjd-cli from PyPI"
  if python3 -m venv "$folder" && "$folder/bin/python3" -m pip install --quiet openjd-cli; then
    touch "$folder/done"
  else
    say "openjd-cli cannot be had from PyPI: its templates are not tested" >&2
    rm -rf "$folder"
  fi
}

rooms=./usr/share/blender/datafiles/studiolights/world
fetch_interior() {
  fetch blender-data "31 MB" "$rooms/interior.exr" 4f6810b182ade346eac6964bf02405adf430c321b8853a644316af4e05d0fdb5
}

fetch_sunset() {
  fetch blender-data "31 MB" "$rooms/sunset.exr" a164f20b86bc43ba4afd66c988a20a9dd5f1a0a5d8e960aed57a33f78119c168
}

# All cores, but at least 1 GB each: the CGAL sources take up to 1.7 GB to compile.
job_count() {
  local cores gigabytes
  cores=$(nproc)
  gigabytes=$(awk '$1 == "MemAvailable:" {print int($2 / 1e6)}' /proc/meminfo 2>/dev/null || true)
  ((${gigabytes:=$cores} > 0)) || gigabytes=1
  echo $((cores < gigabytes ? cores : gigabytes))
}

cache_value() { sed -n "s/^$2:INTERNAL=//p" "$1"; }

# in    a build folder, then options for cmake
configure() {
  local folder=$1 generator=()
  local cache=$folder/CMakeCache.txt
  shift
  if [[ -f $cache && ! ($(cache_value "$cache" CMAKE_HOME_DIRECTORY) -ef $root &&
    $(cache_value "$cache" CMAKE_CACHEFILE_DIR) -ef $folder) ]]; then
    say "$folder was configured for another folder: configuring again"
    rm -rf "$cache" "$folder/CMakeFiles"
  fi
  [[ -f $cache ]] || generator=(-G Ninja)
  # Both commands treat warnings as errors, with the compilers of Debian; different flags would build everything twice.
  logged cmake -S "$root" -B "$folder" "${generator[@]}" --log-level=NOTICE -DCMAKE_COMPILE_WARNING_AS_ERROR=ON "$@" ||
    fail 3 "cmake could not configure $folder"
}

# in    a build folder, then options for cmake --build
build() {
  local folder=$1
  shift
  logged cmake --build "$folder" --parallel "$(job_count)" "$@" || fail 3 "the build in $folder failed"
}
