#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# package_test.sh BUILD_DIR SOURCE_DIR PROGRAM...: makes the Debian packages into BUILD_DIR/packages and looks at
# them without installing: every file and no other, rights, checksums, dependencies; then runs what they hold.
set -euo pipefail
build=$1 source=$2
shift 2
programs=("$@")
for tool in dpkg-deb dpkg-shlibdeps file desktop-file-validate; do
  command -v "$tool" >/dev/null || { echo "missing: $tool (Debian: dpkg-dev, file, desktop-file-utils)"; exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
complain() { echo "$*"; failed=1; }

cmake --build "$build" --target installable >"$work/build.log" || { tail -n 30 "$work/build.log"; exit 1; }
rm -rf "$build/packages"
(umask 077; cpack --config "$build/CPackConfig.cmake") >"$work/cpack.log" 2>&1 ||
  { cat "$work/cpack.log"; exit 1; }
rm -rf "$build/packages/_CPack_Packages"
lib=usr/$(sed -n 's/^CMAKE_INSTALL_LIBDIR:.*=//p' "$build/CMakeCache.txt")

# tree FOLDER TO ENDING...: the files of the source tree with one of these endings, where they are installed.
tree() {
  local from=$1 to=$2 ending
  shift 2
  for ending in "$@"; do (cd "$source/$from" && find . -name "*.$ending" -printf "$to/%P\n"); done
}
{
  for program in "${programs[@]}"; do
    echo "usr/bin/$program"
    echo "usr/share/man/man1/$program.1.gz"
    echo "usr/share/bash-completion/completions/$program"
    echo "usr/share/zsh/vendor-completions/_$program"
    echo "usr/share/fish/vendor_completions.d/$program.fish"
    [ "$program" != knotwave-synth ] || printf 'usr/share/%s\n' applications/knotwave-synth.desktop \
      icons/hicolor/scalable/apps/knotwave-synth.svg
  done
  for folder in banks calibration curves envelopes musicians patches plugins scores sounds tunings; do
    [ ! -d "$source/examples/$folder" ] || tree "examples/$folder" "usr/share/knotwave/examples/$folder" toml mid scl kbm wav flac
  done
  tree docs usr/share/doc/knotwave/docs md svg toml
  printf 'usr/share/doc/knotwave/%s\n' README.md CHANGELOG.md LICENSE changelog.gz copyright examples
} >"$work/knotwave"
{
  for module in base curves curves/c dsp engine io; do tree "$module/include" usr/include h; done
  for module in base curves dsp engine io; do printf '%s\n' "$lib/libknotwave_$module.a" "$lib/pkgconfig/knotwave-$module.pc"; done
  printf "$lib/%s\n" libknotwave_curves_c.so libknotwave_curves_c.so.1 pkgconfig/knotwave-curves-c.pc
  printf "$lib/cmake/knotwave/%s\n" knotwave-config.cmake knotwave-config-version.cmake knotwave_targets.cmake \
    knotwave_targets-release.cmake
  for folder in tutorial c gallery; do tree "examples/$folder" "usr/share/knotwave/examples/$folder" c cpp h; done
  printf 'usr/share/doc/knotwave-dev/%s\n' changelog.gz copyright
} >"$work/knotwave-dev"
{
  printf 'usr/share/doc/knotwave-plugins/%s\n' changelog.gz copyright
  (cd "$build/plugins" && find clap lv2 vst3 -type f -printf 'usr/lib/%p\n')
} >"$work/knotwave-plugins"
[ "$(grep -c '^usr/lib/' "$work/knotwave-plugins")" -ge 6 ] || complain "plugins are missing in $build/plugins"

for package in knotwave knotwave-dev knotwave-plugins; do
  deb=$(echo "$build/packages/${package}"_[0-9]*.deb)
  root=$work/unpacked/$package
  mkdir -p "$root"
  dpkg-deb -x "$deb" "$root"
  dpkg-deb -e "$deb" "$work/$package.control"
  diff <(sort "$work/$package") <(cd "$root" && find . ! -type d -printf '%P\n' | sort) ||
    complain "$package holds other files (< missing, > too many)"
  (cd "$root" && md5sum --quiet -c "$work/$package.control/md5sums") || complain "$package: wrong checksums"
  [ "$(wc -l <"$work/$package.control/md5sums")" = "$(find "$root" -type f | wc -l)" ] || complain "$package: files without a checksum"
  [ ! -e "$work/$package.control/conffiles" ] || complain "$package has conffiles"
  wrong=$(dpkg-deb -c "$deb" | awk '
    { want = $1 ~ /^d/ || $6 ~ /^\.\/usr\/bin\// ? "rwxr-xr-x" : "rw-r--r--" }
    $1 !~ /^l/ && substr($1, 2) != want || $2 != "root/root"')
  [ -z "$wrong" ] || complain "$package: wrong rights:"$'\n'"$wrong"
  while IFS=': ' read -r field value; do
    case $field in
      Package) [ "$value" = "$package" ] ;;
      Maintainer) [[ $value == *"<"*@*">" ]] ;;
      Depends) [[ $value == *"libc6 (>="* && $value != *knotwave* ]] ;;
      *) true ;;
    esac || complain "$package: $field: $value"
  done <"$work/$package.control/control"
  for field in Version Architecture Maintainer Section Priority Depends Description; do
    grep -q "^$field: ." "$work/$package.control/control" || complain "$package: no $field"
  done
done
mapfile -t modules < <(find "$work/unpacked/knotwave-plugins" -name '*.so' -o -name '*.clap')
[ "${#modules[@]}" -ge 3 ] || complain "knotwave-plugins holds only ${#modules[@]} modules"
for binary in "$work"/unpacked/knotwave/usr/bin/* "$work/unpacked/knotwave-dev/$lib/libknotwave_curves_c.so.1" "${modules[@]}"; do
  [[ $(file "$binary") == *", stripped"* ]] || complain "$binary is not stripped"
done
for entry in "$source"/apps/desktop/*.desktop; do
  desktop-file-validate "$entry" || complain "$entry"
  icon=$(sed -n 's/^Icon=//p' "$entry")
  [ -e "$source/apps/desktop/$icon.svg" ] || complain "$entry: no picture of the name $icon"
done

# What a manual page shows of examples/ works in share/knotwave, as it says.
PATH=$work/unpacked/knotwave/usr/bin:$PATH
for program in "${programs[@]}"; do
  [[ $("$program" --version) == "$program "* ]] || complain "$program --version"
done
cd "$work/unpacked/knotwave/usr/share/knotwave"
find examples -name '*.toml' ! -path '*/plugins/*' -print0 | xargs -0 knotwave-curve check >"$work/checked" || { cat "$work/checked"; complain "a shipped example has a fault"; }
count=0
while IFS= read -r command; do
  count=$((count + 1))
  sh -ec "$command" >"$work/output" 2>&1 || { cat "$work/output"; complain "fails: $command"; }
done < <(zcat ../man/man1/*.1.gz | sed -e ':join' -e '/\\e$/{N;s/\\e\n//;b join' -e '}' |
  sed -n 's/\\-/-/g; /^knotwave-[a-z]* .*examples\//p' | sed -E "s, -o ([^-]), -o $work/\1,")
[ "$count" -ge 10 ] || complain "only $count commands of the manual pages name examples/"
echo "$count commands of the manual pages work"
exit $failed
