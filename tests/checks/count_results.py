"""Counts a JUnit file of ctest: prints "PASSED FAILED SKIPPED", then a line per failed test. A test that could not be
started has failed; skipped is only what said so itself (exit code 77)."""

import sys
import xml.etree.ElementTree

passed, failed, skipped = 0, [], 0
for case in xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase"):
    reason = case.find("skipped")
    if case.get("status") == "run":
        passed += 1
    elif reason is not None and "SKIP_RETURN_CODE" in reason.get("message", ""):
        skipped += 1
    else:
        failed.append(case.get("name"))
print(passed, len(failed), skipped)
print("\n".join(failed))
