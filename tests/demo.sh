#!/bin/bash
# The demo with three shots: what it prints, what it leaves, what it leaves behind. demo.sh BUILD
set -u
build=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0 failed=0
check() { # NAME COMMAND...
	local name=$1
	shift
	if "$@"; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $name"
	fi
}
lines() { # NUMBER PATTERN
	[ "$(grep -cE "$2" "$folder/out")" = "$1" ]
}
# A session of its own tells which processes are the demo's.
ln -s "$build/billiard" "$folder/billiard"
SHOTS=3 setsid scripts/demo "$folder" >"$folder/out" 2>"$folder/err" </dev/null &
demo=$!
wait "$demo"
status=$?
cat "$folder/out"

check "status 0, found $status" [ "$status" = 0 ]
check "three lines with position, proposal, result and time" lines 3 \
	'^shot [1-3]: [0-9]+ balls seen, cue ball at \(-?[0-9]+, -?[0-9]+\) mm.*; proposed .* at -?[0-9.]+ deg, [0-9.]+ m/s, to fall:.*[0-9]+ ms from rest to proposal; fell:'
check "the closing line" lines 1 '^3 proposals, all played, 0 pictures failed'
check "no process left behind" [ -z "$(pgrep -s "$demo")" ]
for n in 1 2 3; do
	for kind in camera projector; do
		picture=$folder/demo/shot-$n-$kind.png
		check "$picture is there" [ -s "$picture" ]
		check "$picture is a PNG" [ "$(head -c 8 "$picture" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ]
	done
	# A picture of nothing is a few kB; the light of a proposal is not.
	check "shot-$n-projector.png shows something" [ "$(stat -c %s "$folder/demo/shot-$n-projector.png")" -gt 15000 ]
	# What the camera saw, the projected light on it, is a table with balls to the detector, too.
	"$build/billiard" detect --json "$folder/demo/shot-$n-camera.png" >"$folder/seen" 2>>"$folder/err"
	check "shot-$n-camera.png shows a table" grep -q '"calibrated":true' "$folder/seen"
	balls=$(grep -o '"type"' "$folder/seen" | wc -l)
	seen=$(sed -n "s/^shot $n: \([0-9]*\) balls seen.*/\1/p" "$folder/out")
	check "shot-$n-camera.png shows the $seen balls, found $balls" [ "$balls" = "$seen" ]
done
# The same on photographs; one of them is none.
photos=${DATA:-../shared/data}/photos/with_halo_2
if [ -d "$photos" ]; then
	mkdir "$folder/photos"
	cp "$photos/1.png" "$photos/11.png" "$folder/photos"
	echo "no photograph" >"$folder/photos/5.png"
	scripts/demo "$folder" "$folder/photos" >"$folder/out" 2>"$folder/err" </dev/null
	check "photographs, one of them none: status 2" [ $? = 2 ]
	cat "$folder/out"
	check "a proposal for 1.png" lines 1 '^photo 1: 1.png: 14 balls seen.*; proposed .* -> .*ms from rest to proposal$'
	check "a proposal for 11.png" lines 1 '^photo 2: 11.png: 14 balls seen.*; proposed .* -> .*ms from rest to proposal$'
	check "four pictures" [ "$(find "$folder/demo" -name 'shot-[12]-*.png' -size +14k | wc -l)" = 4 ]
	check "5.png is said to be none" grep -q '5.png' "$folder/err"
else
	echo "demo: photographs SKIPPED, no data at $photos"
fi
mkdir "$folder/empty"
scripts/demo "$folder" "$folder/empty" >"$folder/out" 2>"$folder/err" </dev/null
check "an empty folder: status 2" [ $? = 2 ]
check "an empty folder: one line that names it" [ "$(grep -c "$folder/empty" "$folder/err")$(grep -vc "^with-bus: " "$folder/err")" = 11 ]
[ "$failed" = 0 ] || sed 's/^/    err: /' "$folder/err" | tail -n 20
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
