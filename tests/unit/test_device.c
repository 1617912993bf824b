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

static void test_no_cuda(void)
{
#ifndef SCREE_CUDA
    scree_report report = {0};
    scree_device *device = NULL;
    const scree_device_def def = scree_default_device_def();
    SCREE_CHECK_INT(scree_device_open(&device, &def, &report), SCREE_NO_DEVICE);
    SCREE_CHECK(device == NULL);
    SCREE_CHECK_INT(report.num_messages, 1);
    SCREE_CHECK_CONTAINS(report.messages[0], "this build of scree has no CUDA");
    scree_report_clear(&report);
#endif
}

int main(void)
{
    SCREE_RUN(test_cpu);
    SCREE_RUN(test_no_cuda);
    return SCREE_TEST_END();
}
