// The CPU as a device, and what is said where there is no other.
#include "core/device.h"
#include "harness.h"

static void test_cpu(void)
{
    int32_t here[4] = {1, 2, 3, 4}, back[4] = {0};
    int32_t *there = scree_device_alloc(NULL, 4, sizeof *there), *copy = scree_device_alloc(NULL, 4, sizeof *copy);
    SCREE_CHECK(there != NULL && copy != NULL);
    scree_device_write(NULL, there, here, sizeof here);
    scree_device_zero(NULL, there + 3, sizeof *there);
    scree_device_copy(NULL, copy, there, sizeof here);
    scree_device_read(NULL, back, copy, sizeof back);
    for (int k = 0; k < 4; ++k) SCREE_CHECK_INT(back[k], k < 3 ? k + 1 : 0);
    scree_device_write(NULL, there, NULL, 0);
    SCREE_CHECK_INT(scree_device_status(NULL, NULL), SCREE_OK);
    scree_device_free(NULL, there);
    scree_device_free(NULL, copy);
    scree_device_free(NULL, NULL);
    scree_device_close(NULL);
    SCREE_CHECK(scree_device_alloc(NULL, INT64_MAX, 8) == NULL);
    SCREE_CHECK(scree_device_alloc(NULL, -1, 8) == NULL);
}

/// Without CUDA, or with it and without a GPU: refused with one message. Where there is a GPU, it takes and gives.
static void test_open(void)
{
    scree_report report = {0};
    scree_device *device = NULL;
    const scree_device_def def = scree_default_device_def();
    const scree_status status = scree_device_open(&device, &def, &report);
    SCREE_CHECK((status == SCREE_OK) == (device != NULL));
    SCREE_CHECK_INT(report.num_messages, status == SCREE_OK ? 0 : 1);
    if (status != SCREE_OK && report.num_messages > 0) printf("%s\n", report.messages[0]);
#ifndef SCREE_CUDA
    SCREE_CHECK_INT(status, SCREE_NO_DEVICE);
    SCREE_CHECK_CONTAINS(report.num_messages > 0 ? report.messages[0] : "", "this build of scree has no CUDA");
#endif
    if (device != NULL)
    {
        const double number = 0.1;
        double back = 0;
        double *there = scree_device_alloc(device, 1, sizeof *there);
        scree_device_write(device, there, &number, sizeof number);
        scree_device_read(device, &back, there, sizeof back);
        SCREE_CHECK(back == number);
        SCREE_CHECK_INT(scree_device_status(device, NULL), SCREE_OK);
    }
    scree_device_close(device);
    scree_report_clear(&report);
}

int main(void)
{
    SCREE_RUN(test_cpu);
    SCREE_RUN(test_open);
    return SCREE_TEST_END();
}
