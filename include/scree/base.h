/// \file base.h
/// Version, status codes and reports of scree. Every fallible function returns a scree_status.
#ifndef SCREE_BASE_H
#define SCREE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

#define SCREE_VERSION "0.1.0"

/// Codes and their texts. 0: done. Positive: refused, nothing has changed. Negative: the object is lost, destroy it.
#define SCREE_STATUS_LIST(X)                                                                   \
    X(SCREE_OK, 0, "done")                                                                     \
    X(SCREE_INVALID_INPUT, 1, "the input was refused")                                         \
    X(SCREE_NOT_FOUND, 2, "a file or a name was not found")                                    \
    X(SCREE_BAD_MESH, 3, "a mesh is not a closed, oriented surface without self-intersection") \
    X(SCREE_OUT_OF_MEMORY, 4, "there is not enough memory")                                    \
    X(SCREE_WRITE_FAILED, 5, "a file could not be written")                                    \
    X(SCREE_READ_FAILED, 6, "a file could not be read")                                        \
    X(SCREE_TOO_MANY, 7, "a count exceeds what the indices can hold")                          \
    X(SCREE_INTERRUPTED, 8, "stopped on request")                                              \
    X(SCREE_NO_DEVICE, 9, "there is no GPU that scree can run on")                             \
    X(SCREE_UNSTABLE, -1, "the simulation has left the range of numbers")                      \
    X(SCREE_DEVICE_FAILED, -2, "the GPU has failed")

    typedef enum scree_status
    {
#define SCREE_STATUS_ENUMERATOR(name, value, text) name = value,
        SCREE_STATUS_LIST(SCREE_STATUS_ENUMERATOR)
#undef SCREE_STATUS_ENUMERATOR
    } scree_status;

    /// Text of a status code; never NULL.
    const char *scree_status_text(scree_status status);

    /// Everything that is wrong with an input, collected so that it can be told at once.
    /// Start from {0}; free with scree_report_clear(). A NULL report is allowed everywhere and swallows the messages.
    typedef struct scree_report
    {
        char **messages; ///< (num_messages), each one sentence or more without a final newline
        int num_messages;
        int num_warnings; ///< how many of the messages are warnings: those start with "warning: "
        int max_messages;
    } scree_report;

    /// Adds one message, printf style: what, where, which value, what is allowed, what to do.
    void scree_report_add(scree_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
    /// Adds one message that does not refuse anything; the text gets the prefix "warning: ".
    void scree_report_warn(scree_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
    /// Number of messages that are faults, not warnings.
    int scree_report_num_faults(const scree_report *report);
    /// Frees the messages and makes the report empty again.
    void scree_report_clear(scree_report *report);

#ifdef __cplusplus
}
#endif
#endif
