// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From a target back to the interaction: the problem, and the record of a method.
///
/// A method is a state that improves by iterations. It says what of its state a checkpoint must
/// keep (spans), so that a run stopped after any iteration goes on with the same bits.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "curves/curve.h"
#include "dynamics/simulation.h"
#include "forces/many_body.h"
#include "observe/bonded_distribution.h"
#include "observe/force_equations.h"
#include "optimise/optimiser.h"
#include "problem/sampling_engine.h"
#include "problem/targets.h"

/// Φ, and the friction weights: ω of white friction, those of the modes of memory
/// (forces/pair_memory.h), and of white friction across pairs; U(q) of bonds, angles and dihedrals.
enum unknown_kind {
    UNKNOWN_POTENTIAL,
    UNKNOWN_OMEGA,
    UNKNOWN_MEMORY, ///< of the first mode; those of the others follow
    UNKNOWN_TRANSVERSE = UNKNOWN_MEMORY + PAIR_MEMORY_MAX_MODES,
    UNKNOWN_BONDED, ///< of all groups that are to be found, one after the other
    UNKNOWNS,
};

static inline bool unknown_is_omega(int kind) {
    return kind != UNKNOWN_POTENTIAL && kind != UNKNOWN_BONDED;
}

/// Names in run files, shape [UNKNOWNS]; the modes of memory are one object of that name.
extern const char *const mf_inverse_unknown_names[UNKNOWNS];

/// What variables make: the shapes of curves/shape.h in their order, or the formula of a friction
/// weight, ω = σ(1 − r/r_c)^s beyond r_0, of which the variables are σ in [minimum, maximum], s in
/// [0, 4] and r_0 from the inner cutoff to half-way to the cutoff.
enum { INVERSE_CURVE_BEZIER, INVERSE_CURVE_BSPLINE, INVERSE_CURVE_POWER };

/// What the curve of an unknown's coefficients is added to: nothing; its start (mf_unknowns_start);
/// of a potential −k_B T ln g or the hypernetted-chain inversion of g; or what seems best: the
/// start where the file gives one, else that inversion, in two dimensions −k_B T ln g.
enum unknown_base { BASE_NONE, BASE_START, BASE_MEAN_FORCE, BASE_HNC, BASE_AUTO };

/// Parameters of the formula, in this order everywhere: σ [sqrt(mass/time)], s, r_0 [λ]. Each is a
/// variable unless it is held fixed.
enum { INVERSE_SIGMA, INVERSE_EXPONENT, INVERSE_INNER_CUTOFF, INVERSE_PARAMETERS };

/// How an optimiser writes an unknown as a curve of some variables.
struct unknown_parameters {
    int shape;                        ///< INVERSE_CURVE_…
    int64_t coefficients;             ///< of the curve
    double minimum, maximum;          ///< of a variable [k_B T_0] or [sqrt(mass/time)]
    double inner_cutoff, cutoff;      ///< of a friction weight [λ]
    double fixed[INVERSE_PARAMETERS]; ///< of the formula; NaN: to be found
    int base;                         ///< enum unknown_base, as the file says
};

extern const struct field mf_inverse_potential_fields[], mf_inverse_omega_fields[];

/// The parameters of the formula, of an array shape [INVERSE_PARAMETERS]; the default is NaN.
extern const struct field mf_inverse_fixed_fields[];

/// Parameters of the formula that are to be found.
int mf_inverse_free_parameters(const double fixed[INVERSE_PARAMETERS]);

/// A parameter of a formula as it was found.
struct inverse_parameter {
    double value; ///< NaN: the unknown is no formula
    double error; ///< standard error; 0: held fixed, NaN: not known
};

/// A function of the distance, to be found or known. Borrowed.
struct unknown {
    bool wanted;
    struct unknown_parameters parameters;
    /// To begin with, or NULL: of a potential for each pair type, of a friction weight for all.
    const struct curve *start[COMPOSITION_MAX_PAIRS];
    /// What the curve of the coefficients is added to, shape [points of mf_unknowns_points]; NULL:
    /// nothing. It has the detail of the target that few smooth coefficients cannot have.
    const double *base;
};

/// Where a number of a scene stands: in a curve of a law that is known, in the law of a group of
/// bonds, angles or dihedrals, in a law of local densities, or in the setup.
enum inverse_place {
    INVERSE_OF_POTENTIAL = UNKNOWN_POTENTIAL,
    INVERSE_OF_OMEGA = UNKNOWN_OMEGA,
    INVERSE_OF_MEMORY = UNKNOWN_MEMORY,
    INVERSE_OF_TRANSVERSE = UNKNOWN_TRANSVERSE,
    INVERSE_OF_BONDED = UNKNOWN_BONDED,
    INVERSE_OF_SETUP = UNKNOWNS,
    INVERSE_OF_DYNAMICS,
    INVERSE_OF_INTERACTION,
    INVERSE_OF_WEIGHT, ///< w of a local density, and f of it
    INVERSE_OF_DENSITY_ENERGY,
};

enum { INVERSE_MAX_NUMBERS = 16, INVERSE_NUMBER_NAME_SIZE = 96 };

/// A scalar of the scene that is to be found.
struct inverse_number {
    char name[INVERSE_NUMBER_NAME_SIZE]; ///< its path in the scene, as "dissipative.sigma"
    const char *unit;                    ///< as that of its field
    double minimum, maximum;             ///< its range
    double start;                        ///< to begin with
    enum inverse_place place;
    int part;      ///< curve of the law, which of the interactions or of the local densities, or
                   ///< inverse_group of a group
    size_t offset; ///< in the parameters of that, or in struct simulation_setup
};

/// The number of a group among those of all orders, and back.
static inline int inverse_group(int order, int group) {
    return (int)order * (int)MOLECULES_MAX_GROUPS + group;
}
static inline int inverse_order(int group) {
    return (group / (int)MOLECULES_MAX_GROUPS);
}

/// The curves of a law of the scene. Borrowed.
struct inverse_law {
    int curves;                ///< 0: none; 1: for all pairs; else one for each pair type
    const struct curve *curve; ///< shape [curves]; family NULL: none
};

/// The curve of a pair type, or NULL.
static inline const struct curve *inverse_law_curve(const struct inverse_law *law, int pair) {
    const struct curve *curve = law->curve + (law->curves > 1 ? pair : 0);
    return law->curves > 0 && curve->family ? curve : NULL;
}

/// How a method that moves variables writes U(q): as functions times coefficients that are added to
/// the Boltzmann inversion of the target (problem/parametrisation.h).
struct bonded_shape {
    int64_t coefficients;
    double maximum; ///< of a coefficient, up and down [k_B T_0]
};
extern const struct field mf_inverse_group_fields[];

/// The order of what is no term of molecules: local densities of beads, with an energy f(ρ).
enum { INVERSE_LOCAL_DENSITY = BONDED_KINDS };

/// A group of bonds, angles or dihedrals whose U(q) is to be found, or a local density with f(ρ).
struct bonded_unknown {
    int order;
    int group;               ///< among those of its order, or of the scene's local densities
    struct bonded_bins bins; ///< of its target
    size_t first;            ///< its first value in the target of its order
    struct bonded_shape shape;
};

enum {
    INVERSE_MAX_BONDED = (int)BONDED_KINDS * (int)MOLECULES_MAX_GROUPS + (int)MANY_BODY_MAX_TERMS
};

enum { INVERSE_MAX_STATES = 16 };

/// What is to be fitted. Borrowed by the methods.
struct inverse_problem {
    /// Those that share the unknowns, this one among them, each with targets and a scene of its
    /// own: shape [states]. 0: this one stands alone. Borrowed.
    const struct inverse_problem *const *state;
    size_t states;
    const char *name;        ///< of this state; borrowed
    struct targets targets;  ///< to be fitted
    struct targets compared; ///< by the verification: those and others
    struct unknown unknown[UNKNOWNS];
    size_t numbers;
    struct inverse_number number[INVERSE_MAX_NUMBERS];
    struct inverse_law law[UNKNOWNS];          ///< those of the scene that are known
    struct inverse_law weight, density_energy; ///< of its local densities, a curve for each
    struct inverse_law known; ///< what acts between pairs beside the potential that is looked for
    bool knows_elsewhere;     ///< samples are of an engine that has the known part by itself
    size_t bonded;            ///< groups of which U(q) is to be found
    struct bonded_unknown group[INVERSE_MAX_BONDED];
    const char *mode[PAIR_MEMORY_MAX_MODES]; ///< names of the modes of memory; borrowed
    struct simulation_setup scene;           ///< all but the unknowns; its composition is set
    double core_threshold;                   ///< g* beyond the core is above this, and two errors
    double core_stiffness;                   ///< of the core (mf_core_fill) [k_B T_0/λ²]
    const struct force_equations *forces;    ///< of a trajectory; NULL: none
    const struct sampling_engine *engine;    ///< samples in the place of ours; NULL: none
    uint64_t seed;
    int threads;
    bool trial; ///< a method is made only to refuse what it cannot fit, and makes no more than that
};

/// Replicas that run side by side: of another engine as many as it is given.
static inline int inverse_problem_threads(const struct inverse_problem *problem) {
    const struct sampling_engine *engine = problem->engine;
    return engine && engine->at_once > 0 ? engine->at_once : problem->threads;
}

/// What a ramp of the potential moves and g(r) hardly knows: the pressure at constant volume; the
/// density at constant pressure, where it is compared with a target.
static inline enum target_kind inverse_problem_bulk(const struct inverse_problem *problem) {
    return targets_ask(&problem->compared, TARGET_DENSITY) ? TARGET_DENSITY : TARGET_PRESSURE;
}

/// Curves and numbers that are to be found.
size_t mf_inverse_unknown_count(const struct inverse_problem *problem);

/// Error at or below this many times the noise of target and measurement counts as none.
extern const double mf_inverse_noise_margin;

/// Directions of a curve that the data say least of.
enum { INVERSE_FLAT = 2 };

/// Numbers of a method's own in a row of the history, and characters of its reason.
enum { INVERSE_EXTRA = 14, INVERSE_REASON_SIZE = 640 };

/// What g(r) leaves open of a potential: the ramp A (1 − r/r_c).
struct inverse_ramp {
    double error;        ///< standard error of A [k_B T_0]; 0: not known
    double drift;        ///< of A that the target still asks for [k_B T_0]; part of the error
    double bulk_drift;   ///< the same of what it moves, inverse_problem_bulk
    double bulk;         ///< its derivative by A
    double bulk_open;    ///< its standard error by g(r) alone,
    double bulk_range;   ///< of which this is that of the range of the potential,
    double bulk_samples; ///< and this that of the samples of the fit
    double directions;   ///< of the potential that the data determine,
    double bins;         ///< out of so many
};

/// Which of several starts a fit has gone on from.
enum inverse_start {
    INVERSE_START_ONLY,          ///< there was but one, or it is not decided yet
    INVERSE_START_FORCES,        ///< the forces of the target, which were near at once
    INVERSE_START_FORCES_NEARER, ///< the same, nearer than what g(r) says
    INVERSE_START_TARGET_NEARER, ///< what g(r) says
};

/// What the samples of an inversion forget most slowly.
struct inverse_slowest {
    char quantity[32];  ///< in words; "": not known
    double independent; ///< samples of it that the last ones are worth
};

/// Linear response of the pairs S in each bin to the potential, as an inversion samples it: ∂⟨S_a⟩/
/// ∂Φ_b = −C_ab/k_B T over the known bins of the potential's grid; g = S/S_ideal.
struct inverse_response {
    const double *covariance; ///< C, shape [known, known]; NULL where the method has none
    const double *ideal;      ///< S if g were 1, shape [bins]
};

/// State of a fit after an iteration. Arrays belong to the method.
struct inverse_step {
    uint32_t iteration;    ///< from 0
    uint64_t evaluations;  ///< simulations so far
    uint64_t engine_steps; ///< time steps or Monte Carlo sweeps so far, over all replicas
    double error; ///< mf_targets_error of the best curves so far, as the method measured it
    double noise; ///< what the statistical errors alone would give
    double noise_of_state[INVERSE_MAX_STATES]; ///< the same of each state by its own targets, of
                                               ///< inversions
    double variance;               ///< of error by the noise of what was measured; 0: not known
    double extra[INVERSE_EXTRA];   ///< columns of the method's own
    const double *curve[UNKNOWNS]; ///< on the unknown's points, best so far; NULL: not fitted
    const double *curve_error[UNKNOWNS]; ///< standard errors; NULL where the method has none
    /// Changes of a curve that the data say least of, one standard error each, widest first: shape
    /// [INVERSE_FLAT, points]; NULL where the method has none.
    const double *curve_flat[UNKNOWNS];
    /// Standard errors of the potential if A of its ramp were known; NULL where the method has
    /// none.
    const double *without_ramp;
    struct inverse_ramp ramp;
    struct inverse_slowest slowest;
    enum inverse_start start;
    struct inverse_response response;
    const char *formula; ///< of the curve, as a scene's law "expression" has it; NULL: it is none
    struct inverse_parameter
        parameter[INVERSE_PARAMETERS]; ///< of a friction weight that is a formula
    struct inverse_parameter number[INVERSE_MAX_NUMBERS]; ///< of the problem, the best so far
    const char *begins; ///< another part of the fit that begins after this step, in words; or NULL
    bool finished;
    bool converged; ///< it has settled: by its own measure it can do no better
    bool exhausted; ///< it finished since all was used that it was to use, as populations do, or at
                    ///< a standstill away from a target that may be out of reach
    /// Why it finished without having converged, numbers with the marks of reduced units; or "".
    char reason[INVERSE_REASON_SIZE];
};

/// The same for an optimiser that gave up before that.
void mf_inverse_give_up(struct inverse_step *step);

/// Finish a step of a method that uses up what "parameter" gives it: `exhausted`, and a reason that
/// says whether the error still fell.
/// @param[in] last_better  iteration in which it fell last
void mf_inverse_exhaust(struct inverse_step *step, const char *parameter, uint32_t last_better);

/// Samples that are taken again, as many as there are, until they are as exact as is wanted.
struct inverse_doubling {
    int number, max;      ///< which doubling of this iteration, of how many at most; 0: none
    double noise, wanted; ///< the standard error that is farthest from what it is to be
    const char *unit;     ///< of both, reduced
};

/// A candidate whose simulation has just ended, while it is told of.
struct inverse_candidate {
    uint64_t number;    ///< of this iteration, from 1 on
    double error;       ///< not finite: it failed
    double temperature; ///< over what it should be; 0: not known
    const double *rdf;  ///< as values of that target, NaN where not measured; NULL: not asked for
    /// Its curve of an unknown, shape [points]: made only if somebody looks.
    void (*curve)(const void *context, enum unknown_kind kind, double *curve);
    const void *context;
};

/// Told from time to time inside an iteration, from one thread at a time.
struct inverse_progress {
    uint32_t iteration;
    uint32_t iterations;  ///< at most
    uint64_t done, total; ///< parts of this iteration
    double best;          ///< error of the best so far; 0 or not finite if not known yet
    double min, mean;     ///< of this iteration's candidates; 0 or not finite without
    uint64_t failures;    ///< simulations that left their temperature or blew up
    struct inverse_doubling doubling;
    const struct inverse_candidate *candidate; ///< the last one; NULL: there is none
};

struct inverse_listener {
    void (*report)(void *context, const struct inverse_progress *progress);
    void *context;
};

/// Where a method puts tables of its own.
struct inverse_folder {
    /// Path of a file in it, into OUTPUT_PATH_SIZE bytes (io/output.h).
    void (*file)(void *context, const char *name, char *path);
    void *context;
    const struct units *units; ///< of its files
};

enum { INVERSE_MAX_SPANS = 10240 };

/// What kind of method it is.
enum inverse_kind {
    INVERSE_INVERSION, ///< turns g(r) into Φ by samples of a Monte Carlo of its own (inversion/)
    INVERSE_DIRECT,    ///< finds Φ in one step and simulates nothing
    INVERSE_MATCHING,  ///< moves variables, and simulates the scene with what they make (matching/)
};

/// A part of a method's parameters: its fields, and where in the struct they are counted from.
struct inverse_table {
    const struct field *fields;
    size_t offset;
    const char *shared; ///< name of what several methods have in common, or NULL
};

/// What a method measures of an evaluation.
struct inverse_sampling {
    int64_t every;  ///< steps between samples
    bool rdf_force; ///< g(r) from forces, where the potential allows
    int64_t samples;
};

struct inverse_method {
    const char *name;
    const char *summary; ///< with citation, one line
    enum inverse_kind kind;
    /// What its kind wants to know besides: struct inversion_rule, or a struct of matching/.
    const void *own;
    const struct inverse_table *tables; ///< of the parameter struct; ended by one without fields
    size_t parameters_size;
    size_t state_size;
    struct inverse_sampling (*sampling)(const void *parameters); ///< NULL of an inversion
    const char *const *columns;        ///< names of `extra`, NULL-terminated
    bool finds_potential, finds_omega; ///< whether it can
    bool knows_molecules;              ///< and finds what is unknown of their bonds, too
    bool
        restricted; ///< of an inversion: its potentials are of a form that need not meet the target
    bool meets_integrals; ///< of an inversion: fits those of Kirkwood and Buff, too
    bool knows_states;    ///< fits several states at once
    enum status (*create)(void *state, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters);
    void (*destroy)(void *state);
    /// One iteration, which from the same state does the same tasks (base/parallel.h): after an
    /// interruption it begins again from before, with what its tasks have left.
    enum status (*iterate)(void *state, struct inverse_step *step,
                           const struct inverse_listener *listener);
    /// The part of its steps that it takes, which may be changed between two iterations; NULL: it
    /// has none.
    double *(*damping)(void *state);
    /// List the state; returns the number of spans.
    size_t (*spans)(void *state, struct memory_span *spans);
    /// Write its own tables after an iteration, or NULL. Fails: IO, NO_MEMORY.
    enum status (*write)(const void *state, const struct inverse_folder *folder);
};
