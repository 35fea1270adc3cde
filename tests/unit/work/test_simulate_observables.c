// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checkpoints of simulations with all that can be measured: they hold what was sampled and not what
// will be, and who goes on from one has the same bits.
#include "scene/heading.h"
#include "scene/scene.h"
#include "io/checkpoint.h"
#include "shared/small_inputs.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "work/simulate_observables.h"

#include <stdio.h>

static const char fluid[] =
    "{\"seed\": 1, \"box\": [5, 5, 5], \"particles\": {\"count\": 200}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": \"power\"}, "
    "\"dynamics\": {\"integrator\": \"dpd-verlet\"},\n"
    "\"measure\": {\"equilibration\": 10, \"samples\": 60, \"every\": 2},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 20}, \"etd\": {\"r_maximum\": 1.8}, \"motion\": {\"lags\": "
    "8},\n"
    "\"force_covariance\": {}, \"structure_factor\": {\"q_maximum\": 3}, \"clusters\": "
    "{\"distance\": "
    "0.5},\n\"shear_viscosity\": {\"lags\": 8, \"every\": 2}, \"local_density\": {\"cell\": 2}}\n";

static const char discs[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [12, 12], \"temperature\": 0,\n"
    "\"particles\": {\"count\": 60, \"placement\": \"random\", \"separation\": 1},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20, \"cutoff\": 2}, \"time_step\": "
    "0.01,\n"
    "\"interactions\": {\"self-propulsion\": {\"force\": 1}},\n"
    "\"dynamics\": {\"integrator\": \"euler-maruyama\"},\n"
    "\"measure\": {\"equilibration\": 0, \"samples\": 60, \"every\": 2},\n"
    "\"polarity\": {\"every\": 3, \"lags\": 4}}\n";

static const char hard[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [20, 20], \"time_step\": 0.4,\n"
    "\"particles\": {\"count\": 80, \"placement\": \"random\", \"radius\": 0.5},\n"
    "\"dynamics\": {\"integrator\": \"event-driven\", \"walls\": \"y\"}, \"collisions\": {},\n"
    "\"measure\": {\"equilibration\": 10, \"samples\": 60, \"every\": 2}}\n";

static const char solvent[] =
    "{\"seed\": 2, \"dimensions\": 2, \"box\": [12, 12], \"particles\": {\"count\": 0},\n"
    "\"time_step\": 0.1, \"dynamics\": {\"integrator\": \"collision-dynamics\", \"angle\": 130,\n"
    "\"thermostat\": \"yes\", \"walls\": \"plates\", \"acceleration\": [0.03, 0]},\n"
    "\"measure\": {\"equilibration\": 10, \"samples\": 60, \"every\": 2},\n"
    "\"flow_profile\": {}, \"flow_field\": {}}\n";

static const char molecules[] =
    "{\"seed\": 3, \"box\": [6, 6, 6], \"time_step\": 0.01,\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.8}},\n"
    "\"molecules\": {\"pair\": {\"count\": 50, \"chain\": {\"beads\": [\"A\", \"A\"], \"bond\": "
    "\"spring\"}},\n\"triple\": {\"count\": 30, \"chain\": {\"beads\": [\"A\", \"A\", \"A\"],\n"
    "\"bond\": \"spring\"}}}, \"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 20}, \"bond_lengths\": {}, \"molecule_sizes\": {\"lags\": "
    "5},\n"
    "\"molecule_motion\": {\"every\": 2, \"lags\": 5}, \"kirkwood_buff\": {\"q_maximum\": 2},\n"
    "\"measure\": {\"equilibration\": 10, \"samples\": 60, \"every\": 2}}\n";

static const char *const scenes[] = {fluid, discs, hard, solvent, molecules};
enum { SCENES = sizeof scenes / sizeof *scenes, MIDDLE = 33 };

struct run {
    struct scene scene;
    struct measure_plan plan;
    struct simulate_observables observables;
    struct simulation simulation;
};

/// @param[in] samples  0: those of the scene
static void begin(struct run *run, struct temporary_folder *folder, const char *text,
                  int64_t samples) {
    struct json_document *document;
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
    assert_ok(mf_json_open(&document, temporary_folder_file(folder, "scene.json")));
    struct json_object root = mf_json_root(document);
    struct heading heading;
    mf_json_fields(&root, mf_heading_fields, &heading);
    assert_ok(mf_scene_read(&run->scene, &root, SCENE_FITS_NOTHING, NULL));
    struct json_object measure = mf_json_child(&root, "measure", true);
    mf_json_fields(&measure, mf_measure_plan_fields, &run->plan);
    mf_json_finish(&measure);
    assert_ok(mf_simulate_observables_read(&run->observables, &root, &run->scene.setup));
    mf_json_finish(&root);
    assert_ok(mf_json_close(document, STATUS_OK));
    run->scene.setup.seed = heading.seed;
    run->plan.samples = samples > 0 ? samples : run->plan.samples;
    assert_ok(mf_simulation_init(&run->simulation, &run->scene.setup, &run->scene.start));
    assert_ok(mf_simulate_observables_begin(&run->observables, &run->simulation, &run->plan));
}

static void clear(struct run *run) {
    mf_simulation_clear(&run->simulation);
    mf_simulate_observables_clear(&run->observables);
    mf_scene_clear(&run->scene);
}

static size_t list(struct run *run, struct memory_span *spans) {
    return mf_simulate_observables_spans(&run->observables, &run->simulation, spans);
}

static size_t bytes_of(struct temporary_folder *folder, const char *text, int64_t samples) {
    static struct memory_span spans[SIMULATE_MAX_SPANS];
    struct run run;
    size_t bytes = 0;
    begin(&run, folder, text, samples);
    const size_t count = list(&run, spans);
    for (size_t k = 0; k < count; k++)
        bytes += spans[k].bytes;
    clear(&run);
    return bytes;
}

/// Blocks are nearly as many, however long they are.
static void test_a_checkpoint_does_not_grow_with_the_samples_asked_for(void **state) {
    for (int k = 0; k < SCENES; k++) {
        const size_t few = bytes_of(*state, scenes[k], 1 << 15);
        const size_t many = bytes_of(*state, scenes[k], 1 << 20);
        print_message("scene %d: %zu and %zu bytes\n", k, few, many);
        assert_true(many < few + few / 10);
    }
}

/// All samples that are complete after the first `samples` of them.
static void run_to(struct run *run, int64_t samples) {
    struct measure_plan part = run->plan;
    double temperature;
    part.samples = samples;
    assert_ok(mf_measure_equilibrate(&run->simulation, &part, &temperature, NULL));
    assert_ok(mf_measure_sample(&run->simulation, &part, run->observables.use, NULL));
}

static void assert_same(struct run *a, struct run *b) {
    static struct memory_span first[SIMULATE_MAX_SPANS], second[SIMULATE_MAX_SPANS];
    const size_t count = list(a, first);
    assert_int_equal(list(b, second), count);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(first[k].bytes, second[k].bytes);
        assert_memory_equal(first[k].memory, second[k].memory, first[k].bytes);
    }
}

static void test_all_observables_go_on_with_the_same_bits(void **state) {
    static struct memory_span spans[1 + SIMULATE_MAX_SPANS];
    uint64_t before = 7;
    for (int k = 0; k < SCENES; k++) {
        struct run whole, second;
        spans[0] = (struct memory_span){&before, sizeof before};
        begin(&whole, *state, scenes[k], 0);
        begin(&second, *state, scenes[k], 0);
        run_to(&whole, MIDDLE);
        const char *const file = temporary_folder_file(*state, "checkpoint.bin");
        assert_ok(mf_checkpoint_save(file, 1, spans, 1 + list(&whole, spans + 1)));
        assert_ok(
            mf_simulate_observables_load(&second.observables, &second.simulation, file, 1, spans));
        assert_same(&whole, &second);
        run_to(&whole, whole.plan.samples);
        run_to(&second, whole.plan.samples);
        assert_same(&whole, &second);
        clear(&whole);
        clear(&second);
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_checkpoint_does_not_grow_with_the_samples_asked_for),
        TEST(test_all_observables_go_on_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
