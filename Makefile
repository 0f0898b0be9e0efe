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

PHYSICS := ball bed collide contact contact_ball_real contact_mathavan contact_stronge event inverse model motion predict queue \
	roots sim table trace
SEARCH := budget candidate cost crew export figures frontier geometry plan pool rank refine request respot \
	rules safety scheme share_queue share_steal share_windows shot slot solutions start state step tolerance
VISION := calibration camera colour detector fit linear marker_edges outline pose reason scan scan_changes scan_cloth scan_copy scan_marks scan_place seeds stabilise stages track vision
VISION_CV := capture_cv image_io_cv markers_cv marker_image_cv
# app: what the programs share, room by room
APP_PROCESS := ball_message bus clock frame_slot frame_source message_check message_table process supervisor text
APP_CONFIG := config config_reader config_table config_vision text_file save position shot_file colour_file
APP_CONTROL := fsm stability controller
APP_LIGHT := animation draw draw_field draw_path draw_proposal keyframe picture render window
APP_PLANNER := plan_check plan_message planner_service request_message
APP_VIRTUAL := table_scene table_camera table_camera_ball player
APP_COMMANDS := cmd cmd_calibrate cmd_demo cmd_detect cmd_plan cmd_run cmd_simulate cmd_status overlay plot
APP_PROCESS += event_log private_bus
APP_VIRTUAL += judge_match
APP_COMMANDS += cmd_judge cmd_judge_replay
APP := $(addprefix process/,$(APP_PROCESS)) $(addprefix config/,$(APP_CONFIG)) $(addprefix control/,$(APP_CONTROL)) \
	$(addprefix light/,$(APP_LIGHT)) $(addprefix planner/,$(APP_PLANNER)) $(addprefix virtual/,$(APP_VIRTUAL)) \
	$(addprefix commands/,$(APP_COMMANDS))
# programs: src/app/programs/main_NAME.c becomes build/NAME
PROGRAMS := billiard billiard-vision billiard-planner billiard-infinity billiard-projector billiard-table
# tests/test_NAME.c each; tests/NAME.c shared by them
TESTS := signature message_check animation fsm stability plan_message controller planner_service planner_bus bus process supervisor frame_source services loop replay \
	config position save cmd plot draw render player table_camera contact_real contact_recorded shot_file \
	rules cost geometry frontier pool scheme candidate plan plan_thesis plan_hard plan_complete tolerance refine solutions request \
	ball bed contact predict event inverse model motion queue roots sim sim_hard table trace \
	calibration camera pose scan fit colour stabilise image_io capture stages track vision vision_photos
TEST_SHARED := harness brute_force bus_fixture service_fixture planner_client random poly_judge scenes search_scenes shot_compare thesis_lists vision_rig vision_scene
TESTS += event_log judge_match
# tests that are scripts: tests/NAME.sh, called with the build folder
TEST_SCRIPTS := cli demo planner units
# bench/bench_NAME.c each; bench/NAME.c shared by them
BENCHES := physics accuracy planner planner_bus search vision
# bench/eval_NAME.c each: accuracy on recorded data
EVALS := physics search vision planner
BENCH_SHARED := report plain_sim plain_sim_long vision_eval vision_eval_photos vision_eval_videos vision_eval_rendered hough_cv
# fuzz/fuzz_NAME.c each, seeds in fuzz/corpus/NAME
FUZZERS := position config shot_file colours image bus search controller
FUZZ_SECONDS ?= 20
LCM_TYPES := animation_t ball_t command_t draw_list_t draw_item_t image_t keyframe_t plan_t plan_entry_t plan_shot_t \
	plan_request_t status_t metric_t table_state_t

# ---- flags -----------------------------------------------------------------------------------------------------------

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
WARN_C := -Wstrict-prototypes -Wmissing-prototypes
# -ffp-contract=off: the same bits on every machine and optimisation level.
BASE := $(OPT) -g -ffp-contract=off -fno-math-errno $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer) \
	-D_GNU_SOURCE -Isrc -I$(BUILD) -MMD -MP
CFLAGS_ALL = -std=c17 $(BASE) $(WARN) $(WARN_C) $(CFLAGS)
CXXFLAGS_ALL = -std=c++17 $(BASE) $(WARN) $(CXXFLAGS)

# pkg-config runs once, when the first file is compiled: on a bare machine the packages come first.
APP_PKGS := lcm glib-2.0 libconfig jansson cairo sdl2 libsystemd
APP_CFLAGS = $(eval APP_CFLAGS := $$(shell pkg-config --cflags $(APP_PKGS)))$(APP_CFLAGS)
# opencv4.pc comes with libopencv-dev only, which brings far more than is used here.
CV_CFLAGS := -isystem /usr/include/opencv4
CV_LIBS := -lopencv_aruco -lopencv_calib3d -lopencv_videoio -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
APP_LIBS = $(eval APP_LIBS := $$(shell pkg-config --libs $(APP_PKGS)))$(APP_LIBS)
TEST_LIBS = $(eval TEST_LIBS := $$(shell pkg-config --libs check gsl))$(TEST_LIBS)
LIBS = $(CV_LIBS) $(APP_LIBS) -lm -lpthread

# ---- objects ---------------------------------------------------------------------------------------------------------

obj = $(patsubst %,$(BUILD)/$(1)/%.o,$(2))
PHYSICS_O := $(call obj,src/physics,$(PHYSICS))
SEARCH_O := $(call obj,src/search,$(SEARCH))
VISION_O := $(call obj,src/vision,$(VISION)) $(call obj,src/vision,$(VISION_CV))
APP_O := $(call obj,src/app,$(APP))
LCM_O := $(patsubst %,$(BUILD)/lcmtypes/billiard_%.o,$(LCM_TYPES))
TEST_SHARED_O := $(call obj,tests,$(TEST_SHARED))
ARCHIVES := $(BUILD)/libapp.a $(BUILD)/liblcmtypes.a $(BUILD)/libsearch.a $(BUILD)/libvision.a $(BUILD)/libphysics.a
PROGRAM_BINS := $(addprefix $(BUILD)/,$(PROGRAMS))
TEST_BINS := $(patsubst %,$(BUILD)/tests/test_%,$(TESTS))
FUZZ_BINS := $(patsubst %,$(BUILD)/fuzz_%,$(FUZZERS))
BENCH_SHARED_O := $(call obj,bench,$(BENCH_SHARED)) $(call obj,tests,brute_force bus_fixture planner_client random scenes search_scenes shot_compare thesis_lists)
EVAL_BINS := $(patsubst %,$(BUILD)/bench/eval_%,$(EVALS))
BENCH_BINS := $(patsubst %,$(BUILD)/bench/bench_%,$(BENCHES))

.PHONY: FORCE all demo check check-built bench eval fuzz fuzzers headers lint signatures install clean setup tests programs
.SECONDARY:
.DELETE_ON_ERROR:

all: programs
programs: $(PROGRAM_BINS)
tests: $(TEST_BINS)

$(BUILD)/libphysics.a: $(PHYSICS_O)
$(BUILD)/libsearch.a: $(SEARCH_O)
$(BUILD)/libvision.a: $(VISION_O)
$(BUILD)/libapp.a: $(APP_O)
$(BUILD)/liblcmtypes.a: $(LCM_O)
# A changed list of sources changes the archives.
$(ARCHIVES): Makefile
$(BUILD)/lib%.a:
	@rm -f $@ && $(AR) rcsD $@ $(filter %.o,$^)

$(BUILD)/src/%.o: src/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(MODULE_CFLAGS) -c $< -o $@
$(BUILD)/src/%.o: src/%.cc
	@mkdir -p $(@D)
	$(CXX) $(CXXFLAGS_ALL) $(CV_CFLAGS) -c $< -o $@
$(BUILD)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -Itests $(APP_CFLAGS) -DDATA='"$(DATA)"' -c $< -o $@
$(BUILD)/bench/%.o: bench/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -Itests $(APP_CFLAGS) -DDATA='"$(DATA)"' -c $< -o $@
$(BUILD)/bench/%.o: bench/%.cc
	@mkdir -p $(@D)
	$(CXX) $(CXXFLAGS_ALL) $(CV_CFLAGS) -c $< -o $@

$(BUILD)/fuzz/%.o: fuzz/%.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) $(APP_CFLAGS) -c $< -o $@

# Only the application sees LCM, libconfig, Cairo, SDL and systemd.
$(BUILD)/src/app/%.o: MODULE_CFLAGS = $(APP_CFLAGS) -DBILLIARD_CONFIG_DIR='"$(SYSCONFDIR)"'
# Pixel loops: -O3 makes vectors of them (the same bits: contraction stays off).
$(BUILD)/src/vision/%.o: MODULE_CFLAGS = $(if $(filter -O2,$(OPT)),-O3)

# Another place for configurations is another config.o.
$(BUILD)/sysconfdir: FORCE
	@mkdir -p $(@D)
	@echo '$(SYSCONFDIR)' | cmp -s - $@ || echo '$(SYSCONFDIR)' >$@
$(BUILD)/src/app/config/config.o: $(BUILD)/sysconfdir
FORCE:

# Generated code warns under -Wextra: flags of its own.
$(BUILD)/lcmtypes/.stamp: $(patsubst %,lcmtypes/%.lcm,$(LCM_TYPES))
	@mkdir -p $(@D)
	lcm-gen -c --c-cpath $(@D) --c-hpath $(@D) --cinclude lcmtypes $^
	@touch $@
$(BUILD)/lcmtypes/billiard_%.c: $(BUILD)/lcmtypes/.stamp ;
$(BUILD)/lcmtypes/%.o: $(BUILD)/lcmtypes/%.c
	$(CC) -std=gnu17 $(BASE) -w $(APP_CFLAGS) -c $< -o $@
$(APP_O) $(patsubst %,$(BUILD)/src/app/programs/main_%.o,$(PROGRAMS)) $(TEST_SHARED_O) \
	$(patsubst %,$(BUILD)/tests/test_%.o,$(TESTS)) $(patsubst %,$(BUILD)/bench/bench_%.o,$(BENCHES)) \
	$(patsubst %,$(BUILD)/fuzz/fuzz_%.o,$(FUZZERS)): | $(BUILD)/lcmtypes/.stamp

link = $(CXX) $(BASE) $(LDFLAGS) -Wl,--as-needed -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group
$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(TEST_SHARED_O) $(ARCHIVES)
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/bench/bench_%: $(BUILD)/bench/bench_%.o $(BENCH_SHARED_O) $(ARCHIVES)
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/bench/eval_%: $(BUILD)/bench/eval_%.o $(BENCH_SHARED_O) $(ARCHIVES)
	$(link) $(TEST_LIBS) $(LIBS)
$(BUILD)/fuzz_%: $(BUILD)/fuzz/fuzz_%.o $(ARCHIVES)
	$(link) -fsanitize=fuzzer $(LIBS)
$(PROGRAM_BINS): $(BUILD)/%: $(BUILD)/src/app/programs/main_%.o $(ARCHIVES)
	$(link) $(LIBS)

# ---- what people call ------------------------------------------------------------------------------------------------

setup:
	@scripts/setup

demo: setup
	+@$(MAKE) --no-print-directory -j$(JOBS) programs
	@scripts/demo "$(BUILD)" $(if $(INPUT),"$(INPUT)")

check: setup
	+@$(MAKE) --no-print-directory check-built

check-built: headers
	+@$(MAKE) --no-print-directory -j$(JOBS) programs tests
	@BUILD=$(BUILD) DATA=$(DATA) scripts/run-tests $(BUILD) $(addprefix test_,$(TESTS)) $(TEST_SCRIPTS)

bench: setup
	+@$(MAKE) --no-print-directory -j$(JOBS) programs $(BENCH_BINS)
	@DATA=$(DATA) scripts/run-bench $(BUILD) $(BENCHES)

# Writes tests/signatures.txt anew: a commit that changes it says which entries and why.
signatures: $(BUILD)/tests/test_signature
	@rm -f $(BUILD)/signatures.txt
	@BILLIARD_SIGNATURES=$(BUILD)/signatures.txt $<
	@cp $(BUILD)/signatures.txt tests/signatures.txt
	@git diff --stat -- tests/signatures.txt 2>/dev/null || true

# clang's libFuzzer (packages clang and libclang-rt-14-dev), everything in a folder of its own.
fuzz:
	+@$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/fuzz SAN=address,undefined CC=clang CXX=clang++ OPT=-O1 \
		CFLAGS=-fsanitize=fuzzer-no-link CXXFLAGS=-fsanitize=fuzzer-no-link fuzzers
	@scripts/run-fuzz $(BUILD)/fuzz $(FUZZ_SECONDS) $(FUZZERS)
fuzzers: $(FUZZ_BINS)

# Layout, faults, scripts: scripts/lint. Installs its own tools (scripts/packages-lint).
lint: setup
	@scripts/setup lint
	+@$(MAKE) --no-print-directory $(BUILD)/lcmtypes/.stamp
	@scripts/lint $(BUILD)

# DESTDIR stages, PREFIX and SYSCONFDIR decide; installed files name the final places. Existing configurations are kept as FILE.new beside them.
install: programs
	@scripts/install-files $(BUILD) "$(DESTDIR)" "$(PREFIX)" "$(SYSCONFDIR)" $(PROGRAMS)

eval: setup
	+@$(MAKE) --no-print-directory -j$(JOBS) programs $(EVAL_BINS) $(BUILD)/tests/test_sim $(BUILD)/tests/test_roots
	@scripts/run-eval $(BUILD) $(DATA) $(EVALS)

headers: $(BUILD)/lcmtypes/.stamp
	@CC="$(CC)" BUILD=$(BUILD) scripts/check-headers

clean:
	rm -rf $(BUILD)

%.d: ;
-include $(shell test -d $(BUILD) && find $(BUILD) -name '*.d')
