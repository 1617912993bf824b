/// Status texts and reports: every code has its text, messages keep their order, faults and warnings are told apart.
#include <stdlib.h>

#include "harness.h"
#include "scree/base.h"

static void every_code_has_its_own_text(void)
{
    static const scree_status codes[] = {
#define CODE(name, value, text) name,
        SCREE_STATUS_LIST(CODE)
#undef CODE
    };
    const size_t num_codes = sizeof codes / sizeof codes[0];
    for (size_t i = 0; i < num_codes; ++i)
    {
        SCREE_CHECK(strlen(scree_status_text(codes[i])) > 0);
        for (size_t j = 0; j < i; ++j)
        {
            SCREE_CHECK(codes[i] != codes[j]);
            SCREE_CHECK(strcmp(scree_status_text(codes[i]), scree_status_text(codes[j])) != 0);
        }
    }
    SCREE_CHECK(SCREE_OK == 0);
    SCREE_CHECK(SCREE_UNSTABLE < 0);
    SCREE_CHECK(strcmp(scree_status_text(SCREE_OK), "done") == 0);
    SCREE_CHECK(strcmp(scree_status_text((scree_status)12345), "unknown status") == 0);
}

static void report_keeps_messages_in_order(void)
{
    scree_report report = {0};
    for (int i = 0; i < 1000; ++i)
    {
        if (i % 3 == 0) scree_report_warn(&report, "number %d of %s", i, "many");
        else scree_report_add(&report, "number %d of %s", i, "many");
    }
    SCREE_CHECK_INT(report.num_messages, 1000);
    SCREE_CHECK_INT(report.num_warnings, 334);
    SCREE_CHECK_INT(scree_report_num_faults(&report), 666);
    for (int i = 0; i < report.num_messages; ++i)
    {
        char expected[64];
        snprintf(expected, sizeof expected, "%snumber %d of many", i % 3 == 0 ? "warning: " : "", i);
        SCREE_CHECK(strcmp(report.messages[i], expected) == 0);
    }
    scree_report_clear(&report);
    SCREE_CHECK(report.messages == NULL);
    SCREE_CHECK_INT(report.num_messages, 0);
    SCREE_CHECK_INT(scree_report_num_faults(&report), 0);
    scree_report_add(&report, "usable again");
    SCREE_CHECK_INT(report.num_messages, 1);
    scree_report_clear(&report);
}

static void long_and_odd_messages_stay_whole(void)
{
    enum
    {
        length = 100000
    };
    char *text = malloc(length + 1);
    if (text == NULL) return;
    memset(text, 'x', length);
    text[length] = '\0';
    scree_report report = {0};
    scree_report_add(&report, "%s", text);
    scree_report_add(&report, "100%% of \"%s\"", "%d%n");
    scree_report_add(&report, "%s", "");
    scree_report_warn(&report, "%.17g", 0.1);
    SCREE_CHECK_INT(strlen(report.messages[0]), length);
    SCREE_CHECK(strcmp(report.messages[1], "100% of \"%d%n\"") == 0);
    SCREE_CHECK(strcmp(report.messages[2], "") == 0);
    SCREE_CHECK(strcmp(report.messages[3], "warning: 0.10000000000000001") == 0);
    scree_report_clear(&report);
    free(text);
}

static void null_report_swallows(void)
{
    scree_report_add(NULL, "%d", 1);
    scree_report_warn(NULL, "%d", 1);
    SCREE_CHECK_INT(scree_report_num_faults(NULL), 0);
    scree_report_clear(NULL);
}

int main(void)
{
    SCREE_RUN(every_code_has_its_own_text);
    SCREE_RUN(report_keeps_messages_in_order);
    SCREE_RUN(long_and_odd_messages_stay_whole);
    SCREE_RUN(null_report_swallows);
    return SCREE_TEST_END();
}
