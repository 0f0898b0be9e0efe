#!/bin/bash
# The message types stand on their own: a C client made of nothing but lcmtypes/*.lcm, lcm-gen and LCM's library talks to billiard-planner.
set -u
build=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
passed=0 failed=0

check() {
	if [ "$2" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $1"; fi
}

lcm-gen -c --c-cpath "$dir" --c-hpath "$dir" lcmtypes/*.lcm
check "lcm-gen -c" $?
# shellcheck disable=SC2046
${CC:-gcc} -std=gnu17 -w -I"$dir" $(pkg-config --cflags lcm) -o "$dir/client" tests/outside_client.c "$dir"/*.c $(pkg-config --libs lcm)
check "the client compiles" $?
export LCM_DEFAULT_URL="udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"
# shellcheck disable=SC2016
scripts/with-bus bash -c '
	"$0/billiard-planner" -c config/thesis-table.conf >"$1/planner.log" 2>&1 &
	planner=$!
	timeout 30 "$1/client" "$LCM_DEFAULT_URL"
	status=$?
	kill $planner
	wait $planner || { echo "billiard-planner ended with status $?"; status=1; }
	exit $status' "$build" "$dir"
check "the client gets its proposal" $?
for language in python java lua cpp; do
	mkdir -p "$dir/$language"
	(cd "$dir/$language" && lcm-gen --$language "$OLDPWD"/lcmtypes/*.lcm) >/dev/null 2>&1
	check "lcm-gen --$language" $?
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
