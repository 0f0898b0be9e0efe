#!/bin/bash
# The command line as people and scripts call it: output, exit status, one line on stderr for bad input. cli.sh BUILD
set -u
billiard=$1/billiard
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0 failed=0
unset BILLIARD_CONF

result() { # STATUS NAME
	if [ "$1" = 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $2"
		sed 's/^/    out: /' "$folder/out" | head -3
		sed 's/^/    err: /' "$folder/err" | head -3
	fi
}

call() { # ARGUMENT...: fills out, err, status
	timeout 60 "$billiard" "$@" >"$folder/out" 2>"$folder/err" </dev/null
	status=$?
}

refused() { # PATTERN ARGUMENT...: status 2, nothing on stdout, one line on stderr that matches
	local pattern=$1
	shift
	call "$@"
	[ "$status" = 2 ] && [ ! -s "$folder/out" ] && [ "$(wc -l <"$folder/err")" = 1 ] && grep -q -- "$pattern" "$folder/err"
	result $? "billiard $* (status $status, wanted /$pattern/)"
}

works() { # PATTERN ARGUMENT...: status 0, stderr empty, a line of stdout matches
	local pattern=$1
	shift
	call "$@"
	[ "$status" = 0 ] && [ ! -s "$folder/err" ] && grep -q -- "$pattern" "$folder/out"
	result $? "billiard $* (status $status, wanted /$pattern/)"
}

cat >"$folder/pot.txt" <<'EOF'
# the cue ball sends a red into the pocket in front of it
WHITE0, WHITE, 500, 250
RED1, RED, 850, 425
V, 1500, 750
EOF
printf 'WHITE0, WHITE, 0, 0\nRED1, RED, 300, 0\n' >"$folder/two.txt"
printf 'A, WHITE, 0, 0\n\nB, WHITE, 300, 0\n' >"$folder/whites.txt"
printf 'A, WHITE, 0, 0\nB, RED, 20, 0\n' >"$folder/overlap.txt"
printf 'A, WHITE, 0, 0\nB, RED, 2000, 0\n' >"$folder/off.txt"
printf 'R, RED, 0, 0\n' >"$folder/no-cue.txt"
printf 'W, WHITE, 500, 250\nR, RED, 700, 350\nB, BLACK, -700, -380\n' >"$folder/colours.txt"
sed 's/mu_roll = [0-9.]*/mu_roll = "x"/' config/thesis-table.conf >"$folder/type.conf"
sed '/mu_slide = /d' config/thesis-table.conf >"$folder/missing.conf"
head -c 3000 config/thesis-table.conf >"$folder/cut.conf"

# ---- the dispatcher
works '^billiard [0-9]' --version
works 'simulate .*event' --help
refused 'no command'
refused 'unknown command "dance"' dance
refused 'unrecognized option' --dance
for command in $("$billiard" --help | sed -n 's/^  \([a-z]*\)  *.*/\1/p'); do
	works "usage: billiard $command" "$command" --help
	refused 'unrecognized option' "$command" --dance
	works '^\.SH OPTIONS' help --man "$command"
	works '^--help$' help --complete "$command"
	"$billiard" "$command" --help | grep -oE -- '--[a-z-]+ ' | sort -u >"$folder/listed"
	"$billiard" help --complete "$command" | grep -- -- | sed 's/$/ /' | sort -u | cmp -s - "$folder/listed"
	result $? "help and completion know the same options of $command"
done
works 'billiard\\-plan (1)' help --man
works '^usage: billiard plan' help plan
refused 'unknown command "dance"' help dance
# Words that are too many, numbers with something behind them.
for command in run status demo; do
	refused 'unexpected argument "now"' "$command" now
done
refused 'at most one argument' control seek 1 2
refused -- '--shots: found "5x", allowed a whole number 1 to 1000' demo --shots 5x
refused -- '--seconds: found "0.5abc", allowed a number 0.001 to 3600' status --seconds 0.5abc
refused 'animation-seek: found "5x", wanted seconds' control animation-seek 5x
refused 'cancel: found "1x", wanted the id' control cancel 1x
refused 'pause: found "now", wanted no argument' control pause now
refused 'no command has the name "dance"' control dance

# ---- run: one at a time on a bus
sed '/^services = (/,$d' config/thesis-table.conf >"$folder/none.conf"
echo 'services = ();' >>"$folder/none.conf"
"$billiard" run -c "$folder/none.conf" --bus "memq://cli-$$" 2>"$folder/first" &
first=$!
for _ in $(seq 100); do
	grep -q 'Ctrl-C stops them' "$folder/first" && break
	sleep 0.1
done
call run -c "$folder/none.conf" --bus "memq://cli-$$"
[ "$status" = 1 ] && grep -q "memq://cli-$$: another billiard run is on this bus" "$folder/err"
result $? "a second run on the same bus is refused"
kill "$first"
wait "$first"

# ---- simulate
works 'ball_pocket *RED1 .*TOP-RIGHT' simulate "$folder/pot.txt"
works '"event":"ball_pocket","balls":\["RED1"\],"pocket":"TOP-RIGHT","state":\[{"id":"WHITE0","x":' simulate --json "$folder/pot.txt"
works '"event":"ball_ball","balls":\["WHITE0","RED1"\]' simulate --json --speed 1000 --angle 0 "$folder/two.txt"
works 'ball_ball' simulate -c config/snooker-12ft.conf --speed 1000 --angle 0 --side 0.2 --follow -0.3 --elevation 5 "$folder/two.txt"
# one list of models: the help's, the documentation's and the configurations'
models=$("$billiard" help --complete simulate --model | paste -sd, | sed 's/,/, /g')
[ -n "$models" ] && "$billiard" plan --help | grep -qF -- "$models" && grep -qF "$models" docs/configuration.md &&
	grep -qF "$models" config/thesis-table.conf && grep -qF "$models" config/snooker-12ft.conf
result $? "one list of models: $models"
for model in ${models//,/ }; do
	works 'rolling_stationary' simulate --model "$model" --speed 1000 --angle 0 "$folder/two.txt"
done
call simulate --json "$folder/pot.txt"
cp "$folder/out" "$folder/first"
call simulate --json "$folder/pot.txt"
cmp -s "$folder/out" "$folder/first"
result $? "the same shot twice, byte by byte"
if command -v python3 >/dev/null; then
	python3 -c 'import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [l["t"] for l in lines] == sorted(l["t"] for l in lines)
assert all(set(b) == {"id", "x", "y", "vx", "vy", "w", "phase"} for l in lines for b in l["state"])
assert all(b["phase"] in ("REST", "POTTED") for b in lines[-1]["state"])' "$folder/first" 2>"$folder/err"
	result $? "each line is JSON, in order of time, with every ball's state"
fi
works 'ball_pocket' simulate --plot "$folder/plot.svg" "$folder/pot.txt"
grep -q '</svg>' "$folder/plot.svg"
result $? "--plot writes an SVG"
works 'ball_pocket' simulate --plot "$folder/plot.png" "$folder/pot.txt"
[ "$(head -c 4 "$folder/plot.png" | tail -c 3)" = PNG ]
result $? "--plot writes a PNG"
timeout 60 "$billiard" simulate - <"$folder/pot.txt" >"$folder/out" 2>"$folder/err" && grep -q ball_pocket "$folder/out"
result $? "- is standard input"

refused 'wants one position' simulate
refused 'wants one position' simulate "$folder/two.txt" "$folder/pot.txt"
refused 'nonexistent: No such file' simulate "$folder/nonexistent"
refused ': is a folder' simulate "$folder"
refused 'two.txt: neither a V line nor --speed' simulate "$folder/two.txt"
refused 'whites.txt:3: a second cue ball, B' simulate "$folder/whites.txt"
refused 'overlap.txt:2: B overlaps A' simulate "$folder/overlap.txt"
refused 'off.txt:2: B: .* not on the bed' simulate "$folder/off.txt"
refused 'no-cue.txt: no cue ball' simulate --speed 1000 --angle 0 "$folder/no-cue.txt"
refused -- '--speed: found "fast", allowed a number 0.001 to 20000' simulate --speed fast --angle 0 "$folder/two.txt"
refused -- '--speed: found "0"' simulate --speed 0 --angle 0 "$folder/two.txt"
refused -- '--angle: found "nan"' simulate --speed 1 --angle nan "$folder/two.txt"
refused 'belong together' simulate --speed 1 "$folder/two.txt"
refused 'miss the ball' simulate --side 0.8 --follow 0.8 "$folder/pot.txt"
refused -- '--model: found "dream", allowed thesis' simulate --model dream "$folder/pot.txt"
refused 'ends neither in .svg nor in .png' simulate --plot a.gif "$folder/pot.txt"
refused '^/nonexistent/a.svg: ' simulate --plot /nonexistent/a.svg "$folder/pot.txt"
refused "type.conf:[0-9]*: material.mu_roll: found \"x\", allowed a number 0.001 to 0.1" simulate -c "$folder/type.conf" "$folder/pot.txt"
works 'ball_pocket' simulate -c "$folder/missing.conf" "$folder/pot.txt"
cp "$folder/out" "$folder/first"
call simulate "$folder/pot.txt"
cmp -s "$folder/out" "$folder/first"
result $? "a key that is missing is as in the shipped configuration"
sed 's/mu_slide = /mu_slid = /' config/thesis-table.conf >"$folder/misspelt.conf"
refused "misspelt.conf:[0-9]*: material.mu_slid: found an unknown key (nearest is mu_slide)" simulate -c "$folder/misspelt.conf" "$folder/pot.txt"
refused 'cut.conf:[0-9]*: syntax error' simulate -c "$folder/cut.conf" "$folder/pot.txt"

# ---- shots of another simulator
printf '{"table": {}, ' >"$folder/cut.json"
printf '{"table": {}}' >"$folder/empty.json"
refused 'nonexistent.json: ' simulate --shot "$folder/nonexistent.json"
refused 'cut.json:' simulate --shot "$folder/cut.json"
refused 'empty.json:' simulate --shot "$folder/empty.json"
refused 'wants one position, or one --shot' simulate --shot "$folder/empty.json" "$folder/pot.txt"

# ---- fsm: the controller's table
works 'SHOWING MOVING SHOT / clear' fsm
works 'digraph fsm' fsm --dot
refused 'nonsense' fsm --nonsense
refused 'fsm' fsm word

# ---- judge: what is no log
refused 'no log' judge
refused 'takes no log' judge --live "$folder/text.png"
refused 'nonexistent.lcmlog' judge --replay "$folder/nonexistent.lcmlog"
refused 'pot.txt: byte 0' judge --replay "$folder/pot.txt"
loop=${DATA:-../shared/data}/loop
if [ -r "$loop/catch-1.lcmlog" ]; then
	works '"balls":14.*"frames":89,"frames_lost":0' judge --replay --json "$loop/catch-1.lcmlog"
	works '"shots":4,"rests":4,"requests":7,"wrong":6,.*"more_than_one_request":1,' judge --json --out "$folder/wrong" "$loop/C-471-seen-twice-4-requests.lcmlog"
	[ "$(find "$folder/wrong" -name "*lcmlog*" | wc -l)" = 6 ] && [ "$(grep -c 'rest 2: double' "$folder/wrong/README")" = 4 ]
	result $? "judge --out keeps a replay of each wrong rest"
	refused 'holds no CAMERA' judge --replay --json "$loop/C-471-seen-twice-4-requests.lcmlog"
	head -c 5000000 "$loop/catch-1.lcmlog" >"$folder/cut.lcmlog"
	refused 'cut.lcmlog: byte 49[0-9]*: an event cut short' judge --replay --json "$folder/cut.lcmlog"
fi

# ---- detect: what is no photograph. What is one, tests/ and eval see to.
printf 'P6 1 1 255 abc' >"$folder/text.png"
refused 'wants images' detect
refused 'nonexistent.png' detect "$folder/nonexistent.png"
refused 'text.png' detect "$folder/text.png"
refused 'overlay takes one image' detect --overlay "$folder/o.png" "$folder/plot.png" "$folder/plot.png"
refused 'dump takes one image' detect --dump "$folder/d" "$folder/plot.png" "$folder/plot.png"
refused 'o.jpg" does not end in .png' detect --overlay "$folder/o.jpg" "$folder/plot.png"
cp "$folder/plot.png" "$folder/kept.png"
refused 'plot.png is the photograph itself' detect --overlay "$folder/plot.png" "$folder/plot.png"
ln -s plot.png "$folder/link.png"
refused 'link.png is the photograph itself' detect --overlay "$folder/link.png" "$folder/plot.png"
cmp -s "$folder/plot.png" "$folder/kept.png"
result $? "--overlay leaves the photograph alone"
call detect --json "$folder/text.png" "$folder/plot.png"
[ "$status" = 2 ]
result $? "detect: one bad image of two gives status 2"

# ---- plan
works '"rank":1' plan --json --target RED "$folder/pot.txt"
refused 'whites.txt:3: a second cue ball' plan "$folder/whites.txt"
refused 'nonexistent: No such file' plan "$folder/nonexistent"

works '"cue":\[-6' plan --json --in-hand --budget-nodes 200 "$folder/no-cue.txt"
refused 'no white ball' plan "$folder/no-cue.txt"
# Pictures come before the answer: an answer is that of a command that worked.
refused '^/nonexistent/a-1-1.svg: No such file' plan --plot /nonexistent/a.svg "$folder/pot.txt"
works '"plans":' plan --json --plans 2 --plot "$folder/plan.svg" "$folder/pot.txt"
[ -s "$folder/plan-1-1.svg" ]
result $? "plan --plot draws each shot"
works '"side":0.0,"follow":0.0,"elevation_deg":0.0,"cue"' plan --json --ranking success --target RED "$folder/pot.txt"
works '"target":"RED1".*"success":1.0,.*"value":1.*"why":"pot of the last ball"' plan --json --model real --ranking value --error-angle 0.1 --target rules --budget-nodes 3000 "$folder/pot.txt"
works '"target":"B"' plan --json --model real --ranking value --target rules --on colour --budget-nodes 2000 "$folder/colours.txt"
works '"target":"R"' plan --json --model real --ranking value --target rules --budget-nodes 2000 "$folder/colours.txt"
refused 'are for --target rules' plan --target RED --on colour "$folder/pot.txt"
refused 'found "blue", allowed any, red, colour, clearance' plan --on blue "$folder/pot.txt"
refused 'error-angle: found "-1"' plan --error-angle -1 "$folder/pot.txt"

# ---- match: the same seed and nodes, the same result at any number of games at a time
match=(match -c config/snooker-12ft.conf --visits 2 --budget-nodes 1000 --a ranking=value --json)
works '"visits":2,"points_per_visit":' "${match[@]}"
sed 's/"ms_per_proposal":[0-9.]*//' "$folder/out" >"$folder/first"
call "${match[@]}" --workers 2
sed 's/"ms_per_proposal":[0-9.]*//' "$folder/out" | cmp -s - "$folder/first"
result $? "match at one and two workers"
works '"expected":null' match --visits 1 --budget-nodes 300 --a profile=thesis,ranking=thesis,model=thesis --json
works '"frames":1,"won_a":' match --frames 1 --error-angle 1 --budget-nodes 300 --a ranking=value --b profile=beginner --json
refused 'either --visits or --frames' match
refused 'want a side --b' match --frames 1
refused 'found "best", allowed thesis, success or value' match --visits 1 --a ranking=best
refused 'allowed KEY=VALUE' match --visits 1 --a ranking
refused 'no side has "dance=1"' match --visits 1 --a dance=1

# What detect prints is a position.
echo '{"image":"a.png","calibrated":true,"balls":[{"type":"WHITE","x":500,"y":250},{"type":"RED","x":850,"y":425}]}' >"$folder/seen.json"
works '"target":"RED1"' plan --json "$folder/seen.json"

if [ -w /dev/full ]; then
	ln -s /dev/full "$folder/full.svg"
	timeout 60 "$billiard" simulate --plot "$folder/full.svg" "$folder/pot.txt" >"$folder/out" 2>"$folder/err"
	[ $? = 1 ] && [ ! -s "$folder/out" ] && grep -q 'full.svg: No space left on device' "$folder/err"
	result $? "a full disk for --plot is an error that says so"
	timeout 60 "$billiard" simulate --json "$folder/pot.txt" >/dev/full 2>"$folder/err"
	[ $? = 1 ] && [ "$(wc -l <"$folder/err")" = 1 ]
	result $? "a full disk is an error"
fi

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
