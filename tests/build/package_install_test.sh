#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# package_install_test.sh FOLDER: installs the packages of FOLDER with apt-get, runs every program, purges them, and
# compares the system's files with what they were: nothing is left. As root on Debian; what apt-get had to install
# besides stays, as it would for a user.
set -euo pipefail
folder=$(cd "$1" && pwd)
[ "$(id -u)" = 0 ] || { echo "only root can install packages: run this as root"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export DEBIAN_FRONTEND=noninteractive
apt=(apt-get -qq -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)
if dpkg-query -W -f='${db:Status-Abbrev}' knotwave knotwave-dev 2>/dev/null | grep -q '^.[^n]'; then
  echo "knotwave is installed here already"; exit 1
fi

# What is installed, by name, and every file of the system but what changes by itself or on any installation.
packages() { dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' | sed -n 's/^ii *//p' | sort; }
files() {
  find /bin /boot /etc /lib /opt /sbin /srv /usr /var -xdev \( -path /var/lib/dpkg -o -path /var/lib/apt -o -path /var/cache \
    -o -path /var/log -o -path /var/tmp -o -path /var/lib/systemd -o -name __pycache__ \) -prune -o \
    ! -path /etc/ld.so.cache -printf '%p %y %m %u:%g %l\n' | sort
}
packages >"$work/packages"
files >"$work/files"

"${apt[@]}" install -y --no-install-recommends "$folder"/knotwave_*.deb >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
installed=$(dpkg -L knotwave | sed -n 's,^/usr/bin/,,p')
[ -n "$installed" ] || { echo "the package holds no program"; exit 1; }
for program in $installed; do
  [ "$(command -v "$program")" = "/usr/bin/$program" ] || { echo "$program is not found"; exit 1; }
  "$program" --version
  "$program" --help >/dev/null
done
(cd /usr/share/knotwave && knotwave-curve check examples/banks/*.toml &&
  knotwave-render --quiet examples/patches/bell.toml examples/scores/first-light.mid -o "$work/bell.wav")
knotwave-render --quiet --demo first-light -o "$work/first-light.wav"
if [ -x /usr/bin/knotwave-synth ]; then
  knotwave-synth --audio-api none --duration 1 --plain --record "$work/take.wav" </dev/null
  [ -s "$work/take.wav" ] || { echo "knotwave-synth recorded nothing"; exit 1; }
fi
dpkg --verify knotwave

"${apt[@]}" purge -y knotwave >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
packages >"$work/packages_after"
files >"$work/files_after"
comm -13 "$work/packages" "$work/packages_after" >"$work/brought"
if grep knotwave "$work/brought" || ls /var/lib/dpkg/info/knotwave* 2>/dev/null; then echo "still installed"; exit 1; fi
[ -z "$(comm -23 "$work/packages" "$work/packages_after")" ] || { echo "packages went"; exit 1; }

# New files are those of the packages that apt-get brought along.
{ while IFS= read -r package; do dpkg -L "$package"; done <"$work/brought"; } | sort -u >"$work/theirs"
failed=0
while IFS= read -r line; do
  path=${line%% *}
  case $line in "$path d "*) continue ;; esac  # folders of theirs; a folder of ours holds no file of theirs
  grep -qxF -e "$path" -e "${path#/usr}" "$work/theirs" || { echo "left behind: $line"; failed=1; }
done < <(comm -13 "$work/files" "$work/files_after")
for left in $(find / -xdev \( -path /proc -o -path /sys -o -path /tmp -o -path /var/tmp -o -path "$(dirname "$folder")" \) -prune -o \
  -path '/usr/*knotwave*' -print | head); do
  echo "left behind: $left"; failed=1
done
comm -23 "$work/files" "$work/files_after" | grep . && { echo "gone or changed by the purge"; failed=1; }
echo "installed, ran and left nothing; apt-get brought along: $(tr '\n' ' ' <"$work/brought")"
exit $failed
