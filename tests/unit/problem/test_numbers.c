// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/numbers.h"

#include "curves/formula.h"
#include "dynamics/dpd_verlet.h"
#include "problem/parametrisation.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { PAIRS = 3 };

static const struct dpd_verlet_parameters half = {.lambda = 0.5};

/// A mixture with three soft potentials and one friction weight; a of A-B, sigma, the temperature
/// and lambda are to be found.
struct mixture {
    struct formula_soft_repulsion_parameters soft[PAIRS];
    struct formula_power_omega_parameters power;
    struct curve potential[PAIRS], omega;
    struct table tables[UNKNOWNS];
    struct inverse_problem problem;
};

static void make_tables(const struct mixture *mixture, double a, double sigma,
                        struct table tables[UNKNOWNS]) {
    struct mixture other = *mixture;
    struct table part[PAIRS] = {{0}};
    other.soft[1].a = a;
    other.power.sigma = sigma;
    for (int pair = 0; pair < PAIRS; pair++)
        assert_ok(mf_table_init_potential(
            &part[pair], &(struct curve){&mf_formula_soft_repulsion, &other.soft[pair]}));
    assert_ok(mf_table_stack(&tables[UNKNOWN_POTENTIAL], part, PAIRS));
    for (int pair = 0; pair < PAIRS; pair++)
        mf_table_clear(&part[pair]);
    assert_ok(mf_table_init_omega(&tables[UNKNOWN_OMEGA],
                                  &(struct curve){&mf_formula_power_omega, &other.power}));
}

static void begin(struct mixture *mixture) {
    *mixture = (struct mixture){.soft = {{25, 1}, {30, 1}, {35, 1}}, .power = {3, 1, 0, 1}};
    for (int pair = 0; pair < PAIRS; pair++)
        mixture->potential[pair] = (struct curve){&mf_formula_soft_repulsion, &mixture->soft[pair]};
    mixture->omega = (struct curve){&mf_formula_power_omega, &mixture->power};
    make_tables(mixture, 30, 3, mixture->tables);
    mixture->problem = (struct inverse_problem){
        .numbers = 4,
        .number = {{"conservative.A-B.a", "", 10, 50, 40, INVERSE_OF_POTENTIAL, 1,
                    offsetof(struct formula_soft_repulsion_parameters, a)},
                   {"dissipative.sigma", "", 1, 9, 3, INVERSE_OF_OMEGA, 0,
                    offsetof(struct formula_power_omega_parameters, sigma)},
                   {"temperature", "", 0.5, 1.5, 1, INVERSE_OF_SETUP, 0,
                    offsetof(struct simulation_setup, temperature)},
                   {"dynamics.lambda", "", 0, 1, 0.65, INVERSE_OF_DYNAMICS, 0,
                    offsetof(struct dpd_verlet_parameters, lambda)}},
        .law = {{PAIRS, mixture->potential}, {1, &mixture->omega}},
        .scene = {.temperature = 1,
                  .integrator = &mf_dpd_verlet,
                  .integrator_parameters = &half,
                  .potential = &mixture->tables[UNKNOWN_POTENTIAL],
                  .omega = &mixture->tables[UNKNOWN_OMEGA]}};
}

static void finish(struct mixture *mixture) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_table_clear(&mixture->tables[kind]);
}

static void assert_same_table(const struct table *a, const struct table *b) {
    assert_int_equal(a->curves, b->curves);
    assert_identical(a->cutoff, b->cutoff);
    const size_t count = (size_t)a->curves * (TABLE_INTERVALS + 1) * (size_t)a->terms;
    for (size_t k = 0; k < count; k++)
        assert_identical(a->coefficient[k], b->coefficient[k]);
}

static void test_numbers_apply_gives_the_tables_and_settings_of_a_scene_that_says_so(void **state) {
    (void)state;
    struct mixture mixture;
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    struct table wanted[UNKNOWNS] = {{0}};
    begin(&mixture);
    const double value[] = {20, 5, 0.8, 0.7};
    assert_ok(mf_numbers_apply(&mixture.problem, value, &changed, &own));
    make_tables(&mixture, 20, 5, wanted);
    assert_same_table(changed.scene.potential, &wanted[UNKNOWN_POTENTIAL]);
    assert_same_table(changed.scene.omega, &wanted[UNKNOWN_OMEGA]);
    assert_identical(changed.scene.temperature, 0.8);
    const struct dpd_verlet_parameters *dynamics = changed.scene.integrator_parameters;
    assert_identical(dynamics->lambda, 0.7);
    assert_identical(half.lambda, 0.5);
    // The problem is as it was.
    assert_identical(mixture.problem.scene.temperature, 1);
    assert_identical(mixture.soft[1].a, 30);
    assert_ptr_equal(mixture.problem.scene.potential, &mixture.tables[UNKNOWN_POTENTIAL]);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        mf_table_clear(&wanted[kind]);
    }
    mf_numbers_own_clear(&own);
    finish(&mixture);
}

static void test_numbers_apply_leaves_laws_alone_that_no_number_belongs_to(void **state) {
    (void)state;
    struct mixture mixture;
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    begin(&mixture);
    mixture.problem.number[0] = mixture.problem.number[2];
    mixture.problem.numbers = 1;
    assert_ok(mf_numbers_apply(&mixture.problem, &(double){1.25}, &changed, &own));
    assert_identical(changed.scene.temperature, 1.25);
    assert_ptr_equal(changed.scene.potential, &mixture.tables[UNKNOWN_POTENTIAL]);
    assert_ptr_equal(changed.scene.omega, &mixture.tables[UNKNOWN_OMEGA]);
    assert_null(own.table[UNKNOWN_POTENTIAL].coefficient);
    mf_numbers_own_clear(&own);
    finish(&mixture);
}

static void test_numbers_apply_copies_the_parameters_of_an_interaction(void **state) {
    (void)state;
    static const struct interaction kind = {.name = "two", .parameters_size = 2 * sizeof(double)};
    static const double given[2] = {3, 4};
    const struct inverse_problem problem = {
        .numbers = 1,
        .number = {{.name = "interactions.two.second",
                    .maximum = 9,
                    .place = INVERSE_OF_INTERACTION,
                    .part = 1,
                    .offset = sizeof(double)}},
        .scene = {.interaction = {{&kind, given}, {&kind, given}}, .interactions = 2}};
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    assert_ok(mf_numbers_apply(&problem, &(double){7}, &changed, &own));
    const double *second = changed.scene.interaction[1].parameters;
    assert_identical(second[0], 3);
    assert_identical(second[1], 7);
    assert_identical(given[1], 4);
    assert_ptr_equal(changed.scene.interaction[0].parameters, given);
    mf_numbers_own_clear(&own);
}

/// Two numbers of one law and one of another; the scene's laws stay what they were.
static void test_numbers_apply_changes_laws_of_bonds_and_angles(void **state) {
    (void)state;
    static const int types[3] = {0};
    static const struct molecules_number bond[] = {{"k", 100}, {"length", 0.5}, {NULL, 0}};
    static const struct molecules_number angle[] = {{"k", 20}, {"angle", 90}, {NULL, 0}};
    static struct molecules molecules;
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    double energy;
    molecules_topology(&molecules.topology, molecules_chain(2, types, 3, 1, 2),
                       (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, bond);
    molecules_add_group(&molecules, BONDED_ANGLE, &mf_angle_cosine_squared, angle);
    molecules_add_group(&molecules, BONDED_ANGLE, &mf_angle_harmonic, angle);
    const size_t second = mf_angle_harmonic.fields[1].offset;
    const struct inverse_problem problem = {
        .numbers = 3,
        .number = {{.place = INVERSE_OF_BONDED, .part = inverse_group(BONDED_BOND, 0)},
                   {.place = INVERSE_OF_BONDED,
                    .part = inverse_group(BONDED_ANGLE, 1),
                    .offset = second},
                   {.place = INVERSE_OF_BONDED,
                    .part = inverse_group(BONDED_BOND, 0),
                    .offset = mf_bond_harmonic.fields[1].offset}},
        .scene = {.interaction = {{&mf_molecules, &molecules}}, .interactions = 1}};
    assert_ok(mf_numbers_apply(&problem, (const double[]){300, 120, 0.6}, &changed, &own));
    const struct molecules *found =
        mf_molecules_find(changed.scene.interaction, changed.scene.interactions);
    mf_bonded_value(&found->group[BONDED_BOND][0].curve, 0.7, &energy, NULL);
    assert_close(energy, 0.5 * 300 * 0.1 * 0.1, 1e-12);
    mf_bonded_value(&found->group[BONDED_ANGLE][1].curve, M_PI, &energy, NULL);
    assert_close(energy, 0.5 * 20 * M_PI * M_PI / 9, 1e-12);
    // No number belongs to it.
    assert_ptr_equal(found->group[BONDED_ANGLE][0].curve.parameters,
                     molecules.group[BONDED_ANGLE][0].curve.parameters);
    mf_bonded_value(&molecules.group[BONDED_BOND][0].curve, 0.7, &energy, NULL);
    assert_close(energy, 0.5 * 100 * 0.2 * 0.2, 1e-12);
    mf_numbers_own_clear(&own);
    mf_molecules_clear(&molecules);
}

/// Of two local densities one has numbers: r_c of its weight and c_2 of its energy.
static void test_numbers_apply_changes_laws_of_local_densities(void **state) {
    (void)state;
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    struct weight_parameters of_weight[] = {{0.3, 1.1, 3}, {0.3, 1.1, 3}};
    double of_energy[2][16] = {{1, 2}, {1, 2}}, slope;
    const struct curve weight[] = {{&mf_weight_sanyal_shell, &of_weight[0]},
                                   {&mf_weight_sanyal_shell, &of_weight[1]}};
    const struct curve energy[] = {{&mf_density_energy_polynomial, of_energy[0]},
                                   {&mf_density_energy_polynomial, of_energy[1]}};
    static struct many_body law;
    many_bodies_add(&law, "first", 1, 1, &weight[0], &energy[0]);
    many_bodies_add(&law, "second", 1, 1, &weight[1], &energy[1]);
    assert_true(mf_density_energy_polynomial.size <= sizeof of_energy[0]);
    const struct inverse_problem problem = {
        .numbers = 2,
        .number = {{.place = INVERSE_OF_WEIGHT,
                    .part = 1,
                    .offset = offsetof(struct weight_parameters, cutoff)},
                   {.place = INVERSE_OF_DENSITY_ENERGY,
                    .part = 1,
                    .offset = mf_density_energy_polynomial.fields[1].offset}},
        .weight = {2, weight},
        .density_energy = {2, energy},
        .scene = {.interaction = {{&mf_many_body, &law}}, .interactions = 1}};
    assert_ok(mf_numbers_apply(&problem, (const double[]){1.7, 5}, &changed, &own));
    const struct many_body *found =
        mf_many_body_find(changed.scene.interaction, changed.scene.interactions);
    assert_int_equal(found->terms, 2);
    assert_string_equal(found->term[1].name, "second");
    assert_identical(weight_cutoff(&found->term[0].weight), 1.1);
    assert_identical(weight_cutoff(&found->term[1].weight), 1.7);
    assert_close(mf_density_energy_value(&found->term[0].energy, 3, &slope), 3 + 2 * 9, 1e-12);
    assert_close(mf_density_energy_value(&found->term[1].energy, 3, &slope), 3 + 5 * 9, 1e-12);
    // The scene's own stay what they were.
    assert_identical(weight_cutoff(&law.term[1].weight), 1.1);
    assert_close(mf_density_energy_value(&law.term[1].energy, 3, &slope), 3 + 2 * 9, 1e-12);
    mf_numbers_own_clear(&own);
    mf_many_body_clear(&law);
}

/// Warren's energy is his with the cutoff of the weight alone: a number that is one of the two
/// cannot be another.
static void test_numbers_apply_refuses_a_cutoff_that_the_energy_has_not(void **state) {
    (void)state;
    struct inverse_problem changed = {0};
    struct numbers_own own = {0};
    struct weight_parameters of_weight = {0, 0.75, 3};
    double of_energy[16] = {25, 0.75};
    const struct curve weight = {&mf_weight_many_body_dpd, &of_weight};
    const struct curve energy = {&mf_density_energy_many_body_dpd, of_energy};
    static struct many_body law;
    many_bodies_add(&law, "crowd", 1, 1, &weight, &energy);
    assert_true(mf_density_energy_many_body_dpd.size <= sizeof of_energy);
    const struct inverse_problem problem = {
        .numbers = 1,
        .number = {{.place = INVERSE_OF_WEIGHT,
                    .offset = offsetof(struct weight_parameters, cutoff)}},
        .weight = {1, &weight},
        .density_energy = {1, &energy},
        .scene = {.interaction = {{&mf_many_body, &law}}, .interactions = 1}};
    assert_fails(mf_numbers_apply(&problem, (const double[]){0.8}, &changed, &own),
                 STATUS_BAD_INPUT, "the cutoff 0.75 is not that of the weight, 0.8");
    mf_numbers_own_clear(&own);
    assert_ok(mf_numbers_apply(&problem, (const double[]){0.75}, &changed, &own));
    mf_numbers_own_clear(&own);
    mf_many_body_clear(&law);
}

static void test_numbers_are_variables_from_minimum_to_maximum_with_errors(void **state) {
    (void)state;
    struct mixture mixture;
    struct parametrisation parametrisation;
    struct inverse_parameter found[INVERSE_MAX_NUMBERS];
    double variables[4], covariance[16] = {0};
    begin(&mixture);
    assert_ok(mf_parametrisation_init(&parametrisation, &mixture.problem));
    assert_int_equal(parametrisation.variables, 4);
    assert_ok(mf_parametrisation_start(&parametrisation, variables));
    const double wanted[] = {0.75, 0.25, 0.5, 0.65}, range[] = {40, 8, 1, 1};
    for (int n = 0; n < 4; n++) {
        assert_close(variables[n], wanted[n], 1e-12);
        covariance[5 * n] = 0.01 * 0.01 * (n + 1) * (n + 1);
    }
    mf_parametrisation_numbers(&parametrisation, variables, covariance, found);
    for (int n = 0; n < 4; n++) {
        assert_close(found[n].value, mixture.problem.number[n].start, 1e-12);
        assert_close(found[n].error, 0.01 * (n + 1) * range[n], 1e-12);
    }
    mf_parametrisation_numbers(&parametrisation, variables, NULL, found);
    assert_true(isnan(found[0].error));
    mf_parametrisation_clear(&parametrisation);
    finish(&mixture);
}

/// Variables of the numbers stand after those of the curves, which stay what they were.
static void test_numbers_stand_behind_the_curves_and_change_none(void **state) {
    (void)state;
    struct mixture mixture;
    struct parametrisation parametrisation;
    struct unknowns_laws laws;
    double variables[6], before[OMEGA_POINTS], after[OMEGA_POINTS];
    begin(&mixture);
    mixture.problem.unknown[UNKNOWN_OMEGA] =
        (struct unknown){.wanted = true,
                         .parameters = {INVERSE_CURVE_BSPLINE, 5, 0, 6, 0, 1, {0}, BASE_NONE},
                         .start = {&mixture.omega}};
    mixture.problem.numbers = 1;
    assert_ok(mf_parametrisation_init(&parametrisation, &mixture.problem));
    assert_int_equal(parametrisation.variables, 6);
    assert_int_equal(parametrisation.first_number, 5);
    assert_ok(mf_parametrisation_start(&parametrisation, variables));
    mf_parametrisation_curve(&parametrisation, UNKNOWN_OMEGA, variables, before);
    variables[5] = 0.25;
    mf_parametrisation_curve(&parametrisation, UNKNOWN_OMEGA, variables, after);
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        assert_identical(after[k], before[k]);
    assert_ok(mf_parametrisation_laws(&parametrisation, variables, &laws));
    struct table wanted[UNKNOWNS] = {{0}};
    make_tables(&mixture, 20, 3, wanted);
    assert_same_table(laws.table[UNKNOWN_POTENTIAL], &wanted[UNKNOWN_POTENTIAL]);
    assert_ptr_equal(laws.table[UNKNOWN_OMEGA], &laws.own.table[UNKNOWN_OMEGA]);
    mf_unknowns_laws_clear(&laws);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_table_clear(&wanted[kind]);
    mf_parametrisation_clear(&parametrisation);
    finish(&mixture);
}

static void test_numbers_bound_is_the_end_that_a_value_has_come_to(void **state) {
    (void)state;
    const struct inverse_number number = {.minimum = -2, .maximum = 8};
    assert_string_equal(mf_numbers_bound(&number, -1.995), "minimum");
    assert_string_equal(mf_numbers_bound(&number, 8), "maximum");
    assert_null(mf_numbers_bound(&number, 0));
    assert_null(mf_numbers_bound(&number, NAN));
}

static void test_numbers_undetermined_are_those_with_most_of_their_range_open(void **state) {
    (void)state;
    const struct inverse_number number = {.minimum = -2, .maximum = 10};
    // Of what is anywhere in the range, the standard deviation is 12/sqrt(12).
    assert_true(mf_numbers_undetermined(&number, &(struct inverse_parameter){4, sqrt(12)}));
    assert_true(mf_numbers_undetermined(&number, &(struct inverse_parameter){4, 1.6}));
    assert_false(mf_numbers_undetermined(&number, &(struct inverse_parameter){4, 1.4}));
    assert_true(mf_numbers_undetermined(&number, &(struct inverse_parameter){4, INFINITY}));
    assert_false(mf_numbers_undetermined(&number, &(struct inverse_parameter){4, NAN}));
    // Pressed against an end by the targets.
    assert_false(mf_numbers_undetermined(&number, &(struct inverse_parameter){10, 3}));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_apply_gives_the_tables_and_settings_of_a_scene_that_says_so),
        cmocka_unit_test(test_numbers_apply_leaves_laws_alone_that_no_number_belongs_to),
        cmocka_unit_test(test_numbers_apply_copies_the_parameters_of_an_interaction),
        cmocka_unit_test(test_numbers_apply_changes_laws_of_bonds_and_angles),
        cmocka_unit_test(test_numbers_apply_changes_laws_of_local_densities),
        cmocka_unit_test(test_numbers_apply_refuses_a_cutoff_that_the_energy_has_not),
        cmocka_unit_test(test_numbers_are_variables_from_minimum_to_maximum_with_errors),
        cmocka_unit_test(test_numbers_stand_behind_the_curves_and_change_none),
        cmocka_unit_test(test_numbers_bound_is_the_end_that_a_value_has_come_to),
        cmocka_unit_test(test_numbers_undetermined_are_those_with_most_of_their_range_open),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
