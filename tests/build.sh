#!/bin/bash
# The Makefile's promises, on a copy: one make after a changed message type, flag or list gives what a fresh build gives; the same objects in
# any folder; the caller's flags; benchmarks that leave the documents alone. build.sh BUILD
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset MAKEFLAGS MAKEOVERRIDES MFLAGS CFLAGS CPPFLAGS CXXFLAGS LDFLAGS
passed=0 failed=0
result() { # STATUS NAME
	if [ "$1" = 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $2"
		tail -n 5 "$folder/said" | sed 's/^/    /'
	fi
}
for copy in a another/place; do
	mkdir -p "$folder/$copy"
	cp -r Makefile src tests bench fuzz lcmtypes scripts docs "$folder/$copy/"
done
said=$folder/said
cd "$folder/a" || exit 1
build() { make --no-print-directory BUILD=build "$@" >"$said" 2>&1; }
rebuilt() { grep -qE "^(CC|CXX|AR|LCM) .*$1" "$said"; }

# ---- message types
objects='build/liblcmtypes.a build/src/app/process/ball_message.o build/src/app/planner/plan_check.o build/src/app/process/clock.o'
# shellcheck disable=SC2086
messages() { build $objects; }
messages
result $? "message types build"
messages && ! rebuilt .
result $? "a second make does nothing"
sleep 0.01
sed -i 's/^\([[:space:]]*\)double  *x,.*/&\n\1double appended;/' lcmtypes/ball_t.lcm
grep -q appended lcmtypes/ball_t.lcm
result $? "ball_t has another field"
messages
rebuilt 'ball_t.lcm' && rebuilt 'billiard_ball_t.c' && rebuilt 'billiard_table_state_t.c' && rebuilt 'ball_message.c' && ! rebuilt 'clock.c'
result $? "who uses ball_t is rebuilt in the same make, nobody else"
grep -q appended build/lcmtypes/billiard_ball_t.h
result $? "the generated header has the field"
messages && ! rebuilt .
result $? "nothing is left for a second make"
touch lcmtypes/ball_t.lcm
messages && rebuilt ball_message.c
result $? "a touched type rebuilds"

# ---- flags
object='build/src/physics/roots.o'
build $object
for change in OPT=-O1 CFLAGS=-DCHANGED CPPFLAGS=-DCHANGED SAN=undefined 'CC=gcc -pipe'; do
	build $object "$change" && rebuilt roots.c
	result $? "$change rebuilds"
	build $object "$change" && ! rebuilt .
	result $? "$change again does not"
done
build $object && rebuilt roots.c
result $? "back again rebuilds"
build build/flags/link
cp build/flags/link before
build build/flags/link && cmp -s build/flags/link before
result $? "the same flags of the linker change nothing"
build build/flags/link LDFLAGS=-Wl,-z,now && ! cmp -s build/flags/link before
result $? "LDFLAGS change what programs and tests depend on"
make -pnrR BUILD=build -f Makefile help 2>/dev/null >database
for binary in billiard billiard-vision tests/test_% bench/bench_%; do
	grep -qE "^build/$binary: .*build/flags/link" database
	result $? "$binary depends on the flags of the linker"
done
build V=1 CFLAGS=-DOF_CFLAGS CPPFLAGS=-DOF_CPPFLAGS $object && grep -q -- '-DOF_CPPFLAGS.*-DOF_CFLAGS.*-ffp-contract=off' "$said"
result $? "the caller's flags arrive, and none of them changes bits"
build build/libphysics.a && sed -i 's/^\(PHYSICS := .*\) collide /\1 /' Makefile && build build/libphysics.a && ! ar t build/libphysics.a | grep -q collide
result $? "a shorter list is a smaller archive"

# ---- the same bits in any folder
build $object
make -C ../another/place BUILD=build $object >"$said" 2>&1
cmp $object ../another/place/$object >"$said" 2>&1
result $? "the same object in another folder"
make -C ../another/place BUILD="$folder/elsewhere" "$folder/elsewhere/src/physics/roots.o" >"$said" 2>&1
cmp $object "$folder/elsewhere/src/physics/roots.o" >"$said" 2>&1
result $? "the same object with another BUILD"

# ---- benchmarks
mkdir -p build/bench
# shellcheck disable=SC2016
printf '#!/bin/sh\necho family,scheme,us,error >"$1/physics.csv"\necho name,ms,mm >"$1/vision.csv"\n' >build/bench/bench_fake
chmod +x build/bench/bench_fake
before=$(cat docs/results/* | cksum)
scripts/run-bench build fake >"$said" 2>&1
[ "$before" = "$(cat docs/results/* | cksum)" ] && [ -s build/vision.svg ]
result $? "make bench leaves docs/results alone and its plots in the build folder"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
