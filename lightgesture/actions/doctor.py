"""What `doctor` does: this machine is examined, and the report printed."""

import json

from lightgesture.console import print_line
from lightgesture.doctor.examination import examine
from lightgesture.doctor.text import lines_of
from lightgesture.errors import ExitStatus


def run_doctor(as_json: bool) -> ExitStatus:
    """Examine and report; SOME_FAILED where something that is needed is broken."""
    report = examine()
    for line in [json.dumps(report.to_dict())] if as_json else lines_of(report):
        print_line(line)
    return ExitStatus.SOME_FAILED if report.problems else ExitStatus.OK
