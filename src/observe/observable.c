// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/observable.h"

#include "observe/bonded_distribution.h"
#include "observe/flow_field.h"
#include "observe/density_profile.h"
#include "observe/flow_profile.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"
#include "observe/shear_viscosity.h"
#include "observe/structure_factor.h"
#include "observe/weighted_density.h"

/// Of which nothing else knows.
extern const struct observable mf_snapshots, mf_polarity_observable;
extern const struct observable mf_clusters, mf_local_density, mf_collisions, mf_conserved;
extern const struct observable mf_molecule_motion, mf_slab, mf_pressure_tensor;

#define BONDED(NAME, kind, ...) &mf_bonded_distribution_##kind,

const struct observable *const mf_observables[] = {
    &mf_rdf_observable,
    &mf_etd_observable,
    &mf_molecule_motion, // before that of beads, which diffuse with their molecules alone
    &mf_motion_observable,
    &mf_thermodynamics_observable,
    &mf_force_covariance_observable,
    &mf_structure_factor,
    &mf_snapshots,
    &mf_collisions,
    &mf_flow_profile,
    &mf_flow_field,
    &mf_polarity_observable,
    &mf_clusters,
    &mf_density_profile_observable,
    &mf_local_density,
    &mf_shear_viscosity,
    BONDED_LIST(BONDED) & mf_molecule_sizes,
    &mf_rdf_intermolecular,
    &mf_kirkwood_buff_observable,
    &mf_conserved,
    &mf_slab,
    &mf_pressure_tensor,
    &mf_weighted_density,
    NULL,
};
_Static_assert(sizeof mf_observables / sizeof *mf_observables <= OBSERVABLES_MAX + 1,
               "OBSERVABLES_MAX");

enum status mf_observable_begin(struct observable_use *use,
                                const struct configuration *configuration,
                                const struct measure_plan *plan) {
    const struct observable *const observable = use->observable;
    if (configuration->simulation == NULL && !observable->of_places)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: a trajectory does not have what it is of",
                              observable->name);
    use->state = mf_memory_zeroed(1, observable->state_size);
    if (use->state == NULL)
        return STATUS_NO_MEMORY;
    return observable->begin(use->state, use->settings, configuration, plan);
}

void mf_observable_end(struct observable_use *use) {
    if (use->state)
        use->observable->clear(use->state);
    mf_memory_free(use->state);
    use->state = NULL;
}

struct observable_kind mf_observable_kind(int kind) {
    if (kind >= OBSERVABLE_TARGETS)
        return (struct observable_kind){0};
    for (size_t place = 0; mf_observables[place]; place++) {
        const struct observable_target *targets = mf_observables[place]->targets;
        for (size_t n = 0; targets && targets[n].name; n++)
            if (kind-- == 0)
                return (struct observable_kind){mf_observables[place], &targets[n], place, n};
    }
    return (struct observable_kind){0};
}

void mf_observable_file(const struct observable_results *results, const char *name, char *path) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.*s/%.255s", OUTPUT_PATH_SIZE - 258, results->folder, name);
}

enum status mf_observable_table(const struct observable_results *results, const char *name,
                                const struct data_column *columns, size_t count, size_t rows) {
    char path[OUTPUT_PATH_SIZE];
    mf_observable_file(results, name, path);
    return mf_data_table_write_in(path, results->units, NULL, columns, count, rows);
}
