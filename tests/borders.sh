#!/bin/bash
# Ways round the borders between rooms, each tried on a copy: scripts/check-headers and scripts/check-lists refuse every one. borders.sh BUILD
set -u
build=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
passed=0 failed=0
result() { # STATUS NAME
	if [ "$1" = 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $2"
		sed 's/^/    /' "$folder/said" | head -5
	fi
}
cp -r Makefile src tests bench fuzz lcmtypes scripts "$folder/"
mkdir "$folder/build" "$folder/kept"
cp -r "$build/src" "$build/lcmtypes" "$build"/lib*.a "$folder/build/"
cd "$folder" || exit 1
cc=${CC:-gcc}
packages=$(pkg-config --cflags lcm glib-2.0 libconfig jansson cairo sdl2 libsystemd)
# Objects of a link-time optimised or instrumented build are not mixed with those made here: compared are names only.
compile() { # FILE: as make would, and into the room's archive
	local object=build/${1%.*}.o room=${1#src/}
	case $room in app/*) room=app-$(cut -d/ -f2 <<<"$room") ;; *) room=${room%%/*} ;; esac
	mkdir -p "${object%/*}"
	# shellcheck disable=SC2086
	$cc -std=c17 -O2 -w -D_GNU_SOURCE -Isrc -Ibuild $packages -MD -MP -c "$1" -o "$object" >>said 2>&1 || return 1
	[ -e "build/lib$room.a" ] || return 0
	cp "build/lib$room.a" kept/archive
	echo "build/lib$room.a" >kept/name
	ar r "build/lib$room.a" "$object" 2>>said
}
headers() { HEADERS_QUICK=1 BUILD=build scripts/check-headers >said 2>&1; }

# refused NAME PATTERN FILE: the text on stdin is added to FILE, which is compiled; check-headers complains as in PATTERN. All is put back.
refused() {
	local name=$1 pattern=$2 file=$3 object=build/${3%.*}.o new=1
	mkdir -p "${file%/*}"
	rm -f kept/*
	[ -e "$file" ] && new=0 && cp "$file" kept/file
	[ -e "$object" ] && cp "$object" kept/object && cp "${object%.o}.d" kept/d
	cat >>"$file"
	: >said
	case $file in *.c) compile "$file" ;; esac
	! headers && grep -qE -- "$pattern" said
	result $? "$name is refused"
	if [ "$new" = 1 ]; then
		rm -f "$file" "$object" && rmdir --ignore-fail-on-non-empty "${file%/*}"
		[ -e kept/archive ] && mv kept/archive "$(cat kept/name)"
	else
		mv kept/file "$file"
		[ -e kept/archive ] && mv kept/archive "$(cat kept/name)"
		[ -e kept/object ] && mv kept/object "$object" && mv kept/d "${object%.o}.d"
	fi
	rm -f kept/*
}

# tried NAME PATTERN: the text on stdin becomes a file of its own in physics; judged together at the end.
tried_names=() tried_patterns=()
tried() {
	local n=${#tried_names[@]}
	tried_names+=("$1") tried_patterns+=("${2//ball.c/try$n.c}")
	cat >"src/physics/try$n.c"
	compile "src/physics/try$n.c"
}
judge_tried() {
	! headers || echo "nothing was refused" >said
	cp said all
	for n in "${!tried_names[@]}"; do
		grep -E "src/physics/try$n\\.c|\\<try$n\\.o" all >said
		grep -qE -- "${tried_patterns[n]}" said
		result $? "${tried_names[n]} is refused"
		rm -f "src/physics/try$n.c"
	done
}

headers
result $? "the rooms as they are"

ball=src/physics/ball.c
# ---- includes that hide
tried "an include of a room above" 'ball.c may not include "app/process/text.h"' <<<'#include "app/process/text.h"'
tried "spaces and comments in an include" 'ball.c may not include' <<<' /* a */ # /* b */ include /* c */ "app/process/text.h" // d'
tried "a broken line" 'ball.c may not include' < <(printf '#inc\\\nlude "app/process/text.h"\n')
tried "a macro as file name" 'hides its file' <<<$'#define FILE_NAME "app/process/text.h"\n#include FILE_NAME'
tried "a way up" 'without . and ..' <<<'#include "../app/process/text.h"'
tried "a way over the own room" 'without . and ..' <<<'#include "physics/../app/process/text.h"'
tried "angle brackets" 'in quotes' <<<'#include <app/process/text.h>'
tried "a system header by its path" 'in quotes|may not include' <<<'#include </usr/include/unistd.h>'
tried "a system header in quotes" 'a path from src|neither' <<<'#include "unistd.h"'
tried "a digraph" 'digraphs' <<<'%:include "app/process/text.h"'
tried "a trigraph" 'trigraphs' <<<'??=include "app/process/text.h"'
tried "a question for a header" '__has_include' <<<$'#if __has_include("app/process/text.h")\n#endif'
tried "an include that is switched off here" 'may not include' <<<$'#ifdef SOMEWHERE_ELSE\n#include "app/process/text.h"\n#endif'
tried "include_next" '#include_next' <<<'#include_next <unistd.h>'
tried "import" '#import' <<<'#import "app/process/text.h"'
tried "a message type in a core" 'may not include "lcmtypes' <<<'#include "lcmtypes/billiard_ball_t.h"'
refused "a file in a subfolder" 'deep/new.c may not include' src/physics/deep/new.c <<<'#include "app/process/text.h"'
refused "a header in a subfolder" 'deep/new.h may not include' src/physics/deep/new.h <<<'#include "app/process/text.h"'
refused "a folder that is no room" 'is in no room' src/other/new.c <<<'int other_new;'
ln -s ../app/process/text.h src/physics/link.h
refused "a link to another room's header" 'link.h|ball.o reads' $ball <<<'#include "physics/link.h"'
rm src/physics/link.h
for header in unistd.h time.h pthread.h fcntl.h sys/time.h threads.h signal.h lcm/lcm.h opencv2/core.hpp; do
	tried "<$header> in a core" "ball.c may not include <$header>" < <(printf '#ifdef NEVER\n#include <%s>\n#endif\n' "$header")
done
refused "OpenCV outside _cv.cc" 'OpenCV only|may not include' src/vision/fit.c <<<$'#ifdef NEVER\n#include <opencv2/core.hpp>\n#endif'
refused "physics beyond balls and tables in vision" 'may not include "physics/sim.h"' src/vision/fit.c <<<'#include "physics/sim.h"'
refused "a room above within the application" 'may not include "app/control/fsm.h"' src/app/light/draw.c <<<'#include "app/control/fsm.h"'
refused "libconfig in the light" 'may not include <libconfig.h>' src/app/light/draw.c <<<'#include <libconfig.h>'
refused "two headers in a circle" 'circle' src/physics/ball.h <<<'#include "physics/table.h"'

# ---- calls without an include
while IFS='|' read -r symbol declaration call; do
	tried "$symbol in physics without a header" "may not call $symbol" <<<"$declaration; long round_about(void); long round_about(void) { return (long)$call; }"
done <<'LIST'
lcm_publish|extern int lcm_publish(void *, const char *, const void *, unsigned)|lcm_publish(0, "", 0, 0)
lcm_publish|extern int lcm_publish(void) __attribute__((weak))|lcm_publish
fopen|extern void *fopen(const char *, const char *)|fopen("a", "w")
fopen|extern void *(*volatile opener)(const char *, const char *); extern void *fopen(const char *, const char *); void *(*volatile opener)(const char *, const char *) = fopen|opener
printf|extern int printf(const char *, ...)|printf("%d", 5)
open|extern int open(const char *, int, ...)|open("a", 0)
clock_gettime|extern int clock_gettime(int, void *)|clock_gettime(0, 0)
time|extern long time(long *)|time(0)
rand|extern int rand(void)|rand()
pthread_create|extern int pthread_create(unsigned long *, const void *, void *(*)(void *), void *)|pthread_create(0, 0, 0, 0)
malloc|extern void *malloc(unsigned long); extern void *volatile kept; void *volatile kept|(kept = malloc(8))
dlsym|extern void *dlsym(void *, const char *)|dlsym(0, "fopen")
syscall|extern long syscall(long, ...)|syscall(1)
getenv|extern char *getenv(const char *)|getenv("HOME")
process_utime|extern long clock_utime(void), process_utime(void)|process_utime()
planner_create|extern int planner_create(void)|planner_create()
LIST
tried "a builtin that prints" 'may not call (puts|printf|putchar)' <<<'void round_about(int n); void round_about(int n) { __builtin_printf("%d", n); }'
tried "assembler" 'gets round the compiler' <<<'__asm__(".globl fopen");'
refused "a call upwards" 'may not call fsm_step' src/app/light/draw.c <<<'extern int fsm_step(void); int round_about(void); int round_about(void) { return fsm_step(); }'
refused "physics beyond balls and tables without a header" 'may not call sim_run' src/vision/fit.c <<<'extern int sim_run(void); int round_about(void); int round_about(void) { return sim_run(); }'
refused "the bus from the virtual table's room" 'may not call lcm_' src/app/virtual/table_scene.c <<<'extern int lcm_handle(void *); int round_about(void); int round_about(void) { return lcm_handle(0); }'

judge_tried

# ---- files that no list names
lists() { MAKEFLAGS='' make --no-print-directory -s lists >said 2>&1; }
lists
result $? "the lists as they are"
for file in src/physics/new.c src/physics/deep/new.c src/app/light/new.c src/vision/new_cv.cc tests/test_new.c tests/new.sh bench/bench_new.c fuzz/fuzz_new.c \
	lcmtypes/new_t.lcm src/physics/new.h src/physics/new.inc src/physics/new.cpp src/search/new.cc; do
	mkdir -p "${file%/*}"
	: >"$file"
	! lists && grep -qE "$file is (in no list|included by nobody|of a kind)" said
	result $? "$file is refused"
	rm "$file"
done
mkdir -p kept
mv src/physics/queue.c kept/
! lists && grep -q 'src/physics/queue is named and not there' said
result $? "a listed file that is not there is refused"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
