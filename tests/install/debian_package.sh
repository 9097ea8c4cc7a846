#!/usr/bin/env bash
# The Debian package: built, listed, unpacked and used.
. "$(dirname "$0")/common.sh"

(cd "$BUILD" && cpack -G DEB -B "$WORK") >cpack.log 2>&1 || { cat cpack.log; fail "cpack"; }
package=$(echo takt_*.deb)
[ -f "$package" ] || fail "no package"
dpkg-deb --info "$package" | tee info.txt
dpkg-deb --contents "$package" | tee contents.txt

for file in bin/takt lib/libtakt.so lib/cmake/takt/takt-config.cmake lib/pkgconfig/takt.pc include/takt/takt.hpp \
    include/takt/program/version.hpp share/takt/schema/machine.xsd share/takt/devices/cd300e.xml share/takt/takt.default \
    libexec/takt/takt-bridge share/takt/idl/takt.idl \
    lib/systemd/system/takt@.service lib/sysusers.d/takt.conf; do
    grep -q " ./usr/$file" contents.txt || fail "the package has no /usr/$file"
done
for library in libc6 libfmt9 libtinyxml2-9 libxml2 libddsc0debian; do
    grep -q "Depends:.*$library" info.txt || fail "the package does not depend on $library"
done
if grep -vE ' root/root ' contents.txt; then fail "files that do not belong to root"; fi

dpkg-deb --extract "$package" unpacked
expect "X (CD300E)" unpacked/usr/bin/takt new machine
