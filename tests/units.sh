#!/bin/bash
# The systemd units: accepted by systemd, locked down, one for each service. units.sh BUILD
set -u
build=$(realpath "$1")
if ! command -v systemd-analyze >/dev/null; then
	echo "units: SKIPPED, no systemd-analyze (package systemd)"
	echo "0 passed, 0 failed"
	exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0 failed=0
result() { # STATUS NAME
	if [ "$1" = 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $2"
	fi
}
# As installed, but with the programs of this build.
for file in systemd/*; do
	sed "s|/usr/local/bin|$build|" "$file" >"$folder/${file##*/}"
done
said=$(systemd-analyze verify "$folder"/* 2>&1 | grep -F "$folder")
[ -z "$said" ]
result $? "systemd-analyze verify: $said"
for unit in vision planner infinity projector; do
	file=systemd/billiard-$unit.service
	grep -q "^ExecStart=/usr/local/bin/billiard-$unit\$" "$file"
	result $? "$file starts billiard-$unit"
	grep -q "billiard-$unit.service" systemd/billiard.target
	result $? "billiard.target wants $unit"
	for line in Type=notify WatchdogSec= Restart=on-failure RestartPreventExitStatus=2 PartOf=billiard.target After=billiard-bus.service; do
		grep -q "^$line" "$file"
		result $? "$file: $line"
	done
done
grep -q 'route replace 239.255.76.67/32 dev lo src 127.0.0.1' systemd/billiard-bus.service
result $? "the bus route"
for file in "$folder"/*.service; do
	exposure=$(systemd-analyze security --offline=yes "$file" 2>/dev/null | sed -n 's/.*exposure level for [^:]*: \([0-9.]*\).*/\1/p')
	echo "${file##*/}: exposure ${exposure:-unknown}"
	# systemd before 250 has no --offline.
	[ -z "$exposure" ] || awk "BEGIN { exit !($exposure <= 2.5) }"
	result $? "${file##*/}: exposure $exposure"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
