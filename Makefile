# Billiard-AI. `make demo` and `make check` set a bare Debian 12 up, build and run; every other target expects the packages.
# BUILD=dir builds elsewhere; SAN=address,undefined (or thread) builds with sanitizers into a folder of its own.

comma := ,
CC := $(if $(filter default,$(origin CC)),gcc,$(CC))
CXX := $(if $(filter default,$(origin CXX)),g++,$(CXX))
OPT ?= -O2
SAN ?=
BUILD ?= build$(if $(SAN),/san-$(subst $(comma),-,$(SAN)))
PREFIX ?= /usr/local
DESTDIR ?=
# where installed configurations live: /etc/billiard for PREFIX=/usr
SYSCONFDIR ?= $(if $(filter /usr,$(PREFIX)),,$(PREFIX))/etc/billiard
DATA ?= ../shared/data
INPUT ?=
JOBS ?= $(shell nproc)

# ---- sources: every file by hand -------------------------------------------------------------------------------------

PHYSICS := ball bed cluster collide contact contact_ball_real contact_mathavan contact_stronge event inverse model motion predict queue \
	roots sim table trace
SEARCH := acceptance budget candidate cost crew estimate export figures frontier geometry plan player_error pool rank refine request respot \
	rules safety scheme share_queue share_steal share_windows shot slot snookered solutions start state step stroke tolerance \
	value value_open value_race value_safety why worth
VISION := calibration camera colour detector fit linear marker_edges outline pose reason region scan scan_changes scan_cloth scan_copy scan_marks scan_place seeds stabilise stages track vision
VISION_CV := capture_cv image_io_cv markers_cv marker_image_cv
# app: what the programs share, room by room
APP_PROCESS := ball_message bus clock frame_slot frame_source message_check message_table options process process_options process_status supervisor text watchdog
APP_CONFIG := config config_default config_reader config_table config_vision text_file save position shot_file colour_file
APP_CONTROL := fsm layout stability game game_watch keeper words controller
APP_LIGHT := animation draw draw_field draw_path draw_proposal keyframe lease picture render window
APP_PLANNER := plan_check plan_message planner_service request_message
APP_VIRTUAL := table_scene table_camera table_camera_ball player
APP_COMMANDS := cmd cmd_calibrate cmd_demo cmd_detect cmd_plan cmd_run cmd_simulate cmd_status match overlay plot cmd_control status_listen status_print
APP_PROCESS += event_log private_bus
APP_VIRTUAL += judge_match
APP_COMMANDS += cmd_fsm
APP_COMMANDS += cmd_judge cmd_judge_replay cmd_match
APP_VIRTUAL += judge
APP_COMMANDS += cmd_judge_run
APP_VIRTUAL += habits sensor_faults table_camera_arm drawn_shot
# programs: src/app/programs/main_NAME.c becomes build/NAME
PROGRAMS := billiard billiard-vision billiard-planner billiard-infinity billiard-projector billiard-table
# tests/test_NAME.c each; tests/NAME.c shared by them
TESTS := signature message_check animation fsm stability plan_message controller controller_faults planner_service planner_bus bus process supervisor frame_source services loop replay \
	config position save options cmd status plot draw render player table_camera contact_real contact_recorded shot_file \
	rules cost geometry frontier pool scheme candidate plan plan_thesis plan_hard plan_complete tolerance refine solutions request \
	ball bed cluster known contact predict event inverse model motion queue roots sim sim_hard table trace \
	calibration camera pose scan fit colour stabilise image_io capture stages track vision vision_photos
TESTS += rules_official match value
TESTS += seeing detector
TESTS += shipped
TEST_SHARED := harness brute_force bus_fixture service_fixture planner_client random poly_judge scenes search_scenes inverse_forward controller_rig shot_compare thesis_lists vision_rig vision_scene
TESTS += event_log judge_match
TESTS += judge
TESTS += habits sensor_faults
TESTS += lease
TESTS += drawn_shot
TESTS += game
# tests that are scripts: tests/NAME.sh, called with the build folder
TEST_SCRIPTS := cli demo planner units build borders
# tests/NAME.c: programs of their own that a test script compiles
TEST_CLIENTS := outside_client
# bench/bench_NAME.c each; bench/NAME.c shared by them
BENCHES := physics accuracy planner planner_bus search vision
# bench/eval_NAME.c each: accuracy on recorded data
EVALS := physics search vision planner
BENCH_SHARED := report plain_sim plain_sim_long vision_eval vision_eval_photos vision_eval_videos vision_eval_rendered hough_cv
# fuzz/fuzz_NAME.c each, seeds in fuzz/corpus/NAME
FUZZERS := position config shot_file colours image bus search controller
FUZZ_SECONDS ?= 20
LCM_TYPES := animation_t ball_t command_t draw_list_t draw_item_t image_t keyframe_t plan_t plan_entry_t plan_shot_t \
	plan_request_t status_t metric_t table_state_t vision_doubt_t stability_t stability_condition_t lease_t game_t

# ---- flags -----------------------------------------------------------------------------------------------------------

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
WARN_C := -Wstrict-prototypes -Wmissing-prototypes
SANITIZE := $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer)
# The same bits on every machine, at every optimisation level, and in whatever folder this is built. Comes after the caller's flags.
SAME_BITS = -ffp-contract=off -fno-math-errno -ffile-prefix-map=$(CURDIR)=. -ffile-prefix-map=$(abspath $(BUILD))=build
BASE = $(OPT) -g $(SANITIZE) -D_GNU_SOURCE -Isrc -I$(BUILD) -MD -MP $(CPPFLAGS)
CFLAGS_ALL = -std=c17 $(BASE) $(WARN) $(WARN_C) $(CFLAGS) $(SAME_BITS)
CXXFLAGS_ALL = -std=c++17 $(BASE) $(WARN) $(CXXFLAGS) $(SAME_BITS)
LINK_FLAGS = $(OPT) -g $(SANITIZE) $(LDFLAGS) -Wl,--as-needed
# The three cores take the time: -O3 makes physics 1.4 times as fast as -O2, with the same bits (contraction stays off). Optimising a whole room
# at link time adds nothing measurable to that, and the rest waits for messages: it is built with OPT.
CORE_CFLAGS := $(if $(filter -O2,$(OPT)),-O3)

# pkg-config runs once, when the first file is compiled: on a bare machine the packages come first.
APP_PKGS := lcm glib-2.0 libconfig jansson cairo sdl2 libsystemd
APP_CFLAGS = $(eval APP_CFLAGS := $$(shell pkg-config --cflags $(APP_PKGS)))$(APP_CFLAGS)
# opencv4.pc comes with libopencv-dev only, which brings far more than is used here.
CV_CFLAGS := -isystem /usr/include/opencv4
# OpenCV 4.7 and later have the markers in objdetect.
CV_LIBS = $(if $(wildcard /usr/include/opencv4/opencv2/objdetect/aruco_detector.hpp),-lopencv_objdetect,-lopencv_aruco) -lopencv_calib3d -lopencv_videoio -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
APP_LIBS = $(eval APP_LIBS := $$(shell pkg-config --libs $(APP_PKGS)))$(APP_LIBS)
TEST_LIBS = $(eval TEST_LIBS := $$(shell pkg-config --libs check gsl))$(TEST_LIBS)
LIBS = $(CV_LIBS) $(APP_LIBS) -lm -lpthread

# V=1 shows the commands, otherwise a short line each.
V ?=
say = $(if $(filter 1,$(V)),,@echo '$(1) $(2)';)

# ---- what is built ---------------------------------------------------------------------------------------------------

obj = $(patsubst %,$(BUILD)/$(1)/%.o,$(2))
PROGRAM_BINS := $(addprefix $(BUILD)/,$(PROGRAMS))
PROGRAM_O := $(call obj,src/app/programs,$(addprefix main_,$(PROGRAMS)))
LCM_O := $(call obj,lcmtypes,$(addprefix billiard_,$(LCM_TYPES)))
LCM_H := $(LCM_O:.o=.h)
# One archive a room. The order is that of linking: each needs only what stands behind it.
APP_ROOMS := commands control virtual planner light process config
ROOMS := $(addprefix app-,$(APP_ROOMS)) lcmtypes search vision physics
OBJECTS_app-commands := $(call obj,src/app/commands,$(APP_COMMANDS))
OBJECTS_app-control := $(call obj,src/app/control,$(APP_CONTROL))
OBJECTS_app-light := $(call obj,src/app/light,$(APP_LIGHT))
OBJECTS_app-virtual := $(call obj,src/app/virtual,$(APP_VIRTUAL))
OBJECTS_app-planner := $(call obj,src/app/planner,$(APP_PLANNER))
OBJECTS_app-process := $(call obj,src/app/process,$(APP_PROCESS))
OBJECTS_app-config := $(call obj,src/app/config,$(APP_CONFIG))
OBJECTS_lcmtypes := $(LCM_O)
OBJECTS_search := $(call obj,src/search,$(SEARCH))
OBJECTS_vision := $(call obj,src/vision,$(VISION) $(VISION_CV))
OBJECTS_physics := $(call obj,src/physics,$(PHYSICS))
OBJECTS_tests := $(call obj,tests,$(TEST_SHARED))
OBJECTS_bench := $(call obj,bench,$(BENCH_SHARED))
archive = $(patsubst %,$(BUILD)/lib%.a,$(1))
ARCHIVES := $(call archive,$(ROOMS))
TEST_ARCHIVE := $(call archive,tests)
BENCH_ARCHIVE := $(call archive,bench)
TEST_BINS := $(patsubst %,$(BUILD)/tests/test_%,$(TESTS))
FUZZ_BINS := $(patsubst %,$(BUILD)/fuzz_%,$(FUZZERS))
EVAL_BINS := $(patsubst %,$(BUILD)/bench/eval_%,$(EVALS))
BENCH_BINS := $(patsubst %,$(BUILD)/bench/bench_%,$(BENCHES))
TEST_O := $(call obj,tests,$(addprefix test_,$(TESTS)))
BENCH_O := $(call obj,bench,$(addprefix bench_,$(BENCHES)) $(addprefix eval_,$(EVALS)))
FUZZ_O := $(call obj,fuzz,$(addprefix fuzz_,$(FUZZERS)))
ROOM_O := $(foreach room,$(ROOMS),$(OBJECTS_$(room)))
ALL_O := $(ROOM_O) $(PROGRAM_O) $(OBJECTS_tests) $(OBJECTS_bench) $(TEST_O) $(BENCH_O) $(FUZZ_O)

.PHONY: FORCE all help soak demo check check-built bench docs-pictures eval fuzz fuzzers headers lists lint signatures generated install clean setup tests programs
.SECONDARY:
.DELETE_ON_ERROR:

all: programs
programs: $(PROGRAM_BINS)
generated: $(LCM_H)
tests: $(TEST_BINS)

# ---- flags and lists rebuild what they reach -------------------------------------------------------------------------

# A file with what was used last, written anew only when that is something else: what depends on it is rebuilt then.
quoted = '$(subst ','\'',$(1))'
$(BUILD)/flags/%: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' $(call quoted,$(TEXT)) | cmp -s - $@ || printf '%s\n' $(call quoted,$(TEXT)) >$@
FORCE:
version = $(shell $(1) --version 2>/dev/null | head -n 1)
$(BUILD)/flags/cc: TEXT = $(CC) $(call version,$(CC)) $(CFLAGS_ALL) $(APP_CFLAGS) $(CORE_CFLAGS)
$(BUILD)/flags/cxx: TEXT = $(CXX) $(call version,$(CXX)) $(CXXFLAGS_ALL) $(CV_CFLAGS)
$(BUILD)/flags/link: TEXT = $(CXX) $(call version,$(CXX)) $(LINK_FLAGS) $(TEST_LIBS) $(LIBS)
$(BUILD)/flags/data: TEXT = $(DATA)
$(BUILD)/flags/sysconfdir: TEXT = $(SYSCONFDIR)
$(foreach room,$(ROOMS) tests bench,$(eval $(BUILD)/flags/lib$(room): TEXT = $(OBJECTS_$(room))))

$(filter-out %_cv.o,$(ALL_O)): $(BUILD)/flags/cc
$(filter %_cv.o,$(ALL_O)): $(BUILD)/flags/cxx
$(OBJECTS_tests) $(TEST_O) $(OBJECTS_bench) $(BENCH_O): $(BUILD)/flags/data
$(BUILD)/src/app/config/config.o: $(BUILD)/flags/sysconfdir

# ---- compile ---------------------------------------------------------------------------------------------------------

$(BUILD)/src/%.o: src/%.c
	@mkdir -p $(@D)
	$(call say,CC,$<)$(CC) $(CFLAGS_ALL) $(ROOM_CFLAGS) -c $< -o $@
$(BUILD)/src/%.o: src/%.cc
	@mkdir -p $(@D)
	$(call say,CXX,$<)$(CXX) $(CXXFLAGS_ALL) $(CV_CFLAGS) -c $< -o $@
$(BUILD)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(call say,CC,$<)$(CC) $(CFLAGS_ALL) -Itests $(APP_CFLAGS) -DDATA='"$(DATA)"' -c $< -o $@
$(BUILD)/bench/%.o: bench/%.c
	@mkdir -p $(@D)
	$(call say,CC,$<)$(CC) $(CFLAGS_ALL) -Itests $(APP_CFLAGS) -DDATA='"$(DATA)"' -c $< -o $@
$(BUILD)/bench/%.o: bench/%.cc
	@mkdir -p $(@D)
	$(call say,CXX,$<)$(CXX) $(CXXFLAGS_ALL) $(CV_CFLAGS) -c $< -o $@
$(BUILD)/fuzz/%.o: fuzz/%.c
	@mkdir -p $(@D)
	$(call say,CC,$<)$(CC) $(CFLAGS_ALL) $(APP_CFLAGS) -c $< -o $@

# The shipped configuration is in it: the defaults of every other one.
$(BUILD)/src/app/config/config_default.o: config/thesis-table.conf

# Only the application sees LCM, libconfig, Cairo, SDL and systemd.
$(BUILD)/src/app/%.o: ROOM_CFLAGS = $(APP_CFLAGS)
$(BUILD)/src/app/config/config.o: ROOM_CFLAGS = $(APP_CFLAGS) -DBILLIARD_CONFIG_DIR='"$(SYSCONFDIR)"'
$(BUILD)/src/physics/%.o $(BUILD)/src/search/%.o $(BUILD)/src/vision/%.o: ROOM_CFLAGS = $(CORE_CFLAGS)

# A message type is a header and a source. Whoever includes the header is known from its .d file, and before the first build from the last line.
$(BUILD)/lcmtypes/billiard_%.h $(BUILD)/lcmtypes/billiard_%.c: lcmtypes/%.lcm
	@mkdir -p $(@D)
	$(call say,LCM,$<)lcm-gen -c --c-cpath $(@D) --c-hpath $(@D) --cinclude lcmtypes $<
# Generated code warns under -Wextra: flags of its own.
$(BUILD)/lcmtypes/%.o: $(BUILD)/lcmtypes/%.c
	$(call say,CC,$<)$(CC) -std=gnu17 $(BASE) -w $(CFLAGS) $(SAME_BITS) $(APP_CFLAGS) -c $< -o $@
$(ALL_O): | $(LCM_H)

# ---- link ------------------------------------------------------------------------------------------------------------

$(foreach room,$(ROOMS) tests bench,$(eval $(call archive,$(room)): $(OBJECTS_$(room)) $(BUILD)/flags/lib$(room)))
$(BUILD)/lib%.a:
	$(call say,AR,$@)rm -f $@ && $(AR) rcsD $@ $(filter %.o,$^)

link = $(call say,LD,$@)$(CXX) $(LINK_FLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^)
$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(TEST_ARCHIVE) $(ARCHIVES) $(BUILD)/flags/link
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/bench/bench_%: $(BUILD)/bench/bench_%.o $(BENCH_ARCHIVE) $(TEST_ARCHIVE) $(ARCHIVES) $(BUILD)/flags/link
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/bench/eval_%: $(BUILD)/bench/eval_%.o $(BENCH_ARCHIVE) $(TEST_ARCHIVE) $(ARCHIVES) $(BUILD)/flags/link
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/fuzz_%: $(BUILD)/fuzz/fuzz_%.o $(ARCHIVES) $(BUILD)/flags/link
	$(link) -fsanitize=fuzzer $(LIBS)
$(PROGRAM_BINS): $(BUILD)/%: $(BUILD)/src/app/programs/main_%.o $(ARCHIVES) $(BUILD)/flags/link
	$(link) $(LIBS)

# ---- what people call: "## " says it in make help --------------------------------------------------------------------

help: ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## /\1\t/p' Makefile | expand -t 16
	@echo
	@echo 'Variables: V=1 shows the commands; BUILD=dir; SAN=address,undefined or SAN=thread; OPT=-O2; JOBS=n; PREFIX, SYSCONFDIR, DESTDIR; DATA=dir; INPUT=dir'

setup: ## installs the packages that are missing
	@scripts/setup

demo: setup ## the whole loop on a virtual table; pictures in build/demo. INPUT=dir: photographs of a table instead
	+@$(MAKE) --no-print-directory -j$(JOBS) programs
	@scripts/demo "$(BUILD)" $(if $(INPUT),"$(INPUT)")

check: setup ## builds and runs all tests; the last line counts them
	+@$(MAKE) --no-print-directory check-built

check-built: ## the same without the setup
	+@$(MAKE) --no-print-directory -j$(JOBS) programs tests
	+@$(MAKE) --no-print-directory -j$(JOBS) headers
	@BUILD=$(BUILD) DATA=$(DATA) scripts/run-tests $(BUILD) $(addprefix test_,$(TESTS)) $(TEST_SCRIPTS)

soak: setup ## plays at speed with every fault, judged: SHOTS on each table
	+@$(MAKE) --no-print-directory -j$(JOBS) programs
	@scripts/soak $(BUILD) $(SHOTS)

bench: setup ## speed against error: a table, build/bench.json and plots in build
	+@$(MAKE) --no-print-directory -j$(JOBS) programs $(BENCH_BINS)
	@DATA=$(DATA) scripts/run-bench $(BUILD) $(BENCHES)

docs-pictures: ## the plots of the last make bench into docs/results, which is tracked
	@scripts/docs-pictures $(BUILD) $(DATA) docs/results

eval: setup ## accuracy on recorded data in DATA: tables and build/eval.json
	+@$(MAKE) --no-print-directory -j$(JOBS) programs $(EVAL_BINS) $(BUILD)/tests/test_sim $(BUILD)/tests/test_roots
	@scripts/run-eval $(BUILD) $(DATA) $(EVALS)

signatures: $(BUILD)/tests/test_signature ## tests/signatures.txt anew: a commit that changes it says which entries and why
	@rm -f $(BUILD)/signatures.txt
	@BILLIARD_SIGNATURES=$(BUILD)/signatures.txt $<
	@cp $(BUILD)/signatures.txt tests/signatures.txt
	@git diff --stat -- tests/signatures.txt 2>/dev/null || true

# clang's libFuzzer (packages clang and libclang-rt-14-dev), everything in a folder of its own.
fuzz: ## every fuzzer for FUZZ_SECONDS (needs clang)
	+@$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/fuzz SAN=address,undefined CC=clang CXX=clang++ OPT=-O1 \
		CFLAGS=-fsanitize=fuzzer-no-link CXXFLAGS=-fsanitize=fuzzer-no-link fuzzers
	@scripts/run-fuzz $(BUILD)/fuzz $(FUZZ_SECONDS) $(FUZZERS)
fuzzers: $(FUZZ_BINS)

headers: $(ARCHIVES) $(PROGRAM_O) lists ## who includes and calls whom: refuses what the rooms forbid
	@CC="$(CC)" BUILD=$(BUILD) scripts/check-headers

LISTED = $(patsubst $(BUILD)/%.o,%,$(filter-out $(LCM_O),$(ALL_O))) $(patsubst %,lcmtypes/%,$(LCM_TYPES)) \
	$(addprefix tests/,$(TEST_SCRIPTS) $(TEST_CLIENTS))
lists: ## refuses files that no list of the Makefile names
	@scripts/check-lists $(LISTED)

# Layout, faults, scripts: scripts/lint. Installs its own tools (scripts/packages-lint).
lint: setup ## layout and static checks of sources and scripts
	@scripts/setup lint
	+@$(MAKE) --no-print-directory generated
	@scripts/lint $(BUILD)

# DESTDIR stages, PREFIX and SYSCONFDIR decide; installed files name the final places. Existing configurations are kept as FILE.new beside them.
install: programs ## programs, configuration, units, documents; DESTDIR, PREFIX, SYSCONFDIR
	@scripts/install-files $(BUILD) "$(DESTDIR)" "$(PREFIX)" "$(SYSCONFDIR)" $(PROGRAMS)

clean: ## removes the build folder
	rm -rf $(BUILD)

%.d: ;
-include $(shell test -d $(BUILD) && find $(BUILD) -name '*.d')
