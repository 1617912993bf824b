/// \file device_argument.h
/// The option --device of commands that make steps, or plan to.
#ifndef SCREE_DEVICE_ARGUMENT_H
#define SCREE_DEVICE_ARGUMENT_H

#include "core/device.h"

/// "cpu", "cuda" or "cuda:N" to the number of a GPU, -1 for the CPU. False: it is none of these.
bool scree_parse_device(const char *text, int32_t *number);

/// Opens the GPU of this number; *device is NULL for -1.
scree_status scree_open_device(int32_t number, scree_device **device, scree_report *report);

#endif
