/// \file averages_hdf5.h
/// The averages of a run in its checkpoint. Internal to io.
#ifndef SCREE_AVERAGES_HDF5_H
#define SCREE_AVERAGES_HDF5_H

#include "io/hdf5_file.h"

/// Writes group /averages; nothing if the simulation keeps none.
bool scree_averages_put(hid_t file, const scree_simulation *simulation);
/// Reads them into the simulation for a state of num_contacts. is_read: false, with a warning, if the file has none of
/// this section of the scene. SCREE_READ_FAILED: they are damaged; those of the simulation start anew.
scree_status scree_averages_get(hid_t file, scree_simulation *simulation, int64_t num_contacts, bool *is_read,
                                scree_report *report);

#endif
