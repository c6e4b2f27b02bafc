#!/usr/bin/env python3
"""AWS Batch: the job definition and what batch.sh submits, by the API's own description in botocore. test_batch.py FOLDER

A made-up aws stands on PATH and notes what it is asked for. Skips (77) where botocore is not there (Debian:
python3-botocore).
"""

import json
import os
import re
import subprocess
import sys
import tempfile

try:
    import botocore.session
    import botocore.validate
except ImportError:
    print("skipped: no botocore (Debian: python3-botocore)")
    sys.exit(77)

FOLDER = sys.argv[1]
API = botocore.session.get_session().get_service_model("batch")
NAMES = {"register-job-definition": "RegisterJobDefinition", "submit-job": "SubmitJob"}
AWS = """#!/usr/bin/env python3
import json, os, sys
with open(os.environ["NOTED"], "a") as file:
    file.write(json.dumps(sys.argv[1:]) + "\\n")
print("job-%d" % os.path.getsize(os.environ["NOTED"]))
"""


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def check(operation, given):
    report = botocore.validate.ParamValidator().validate(given, API.operation_model(operation).input_shape)
    expect(not report.has_errors(), f"{operation}: {report.generate_report()}")


def value_of(text):
    """JSON, or the short form a=1,b=2 of the command line."""
    if text.startswith("{"):
        return json.loads(text)
    return dict(pair.split("=", 1) for pair in text.split(","))


def request_of(arguments):
    given, operation = {}, NAMES[arguments[1]]
    members = API.operation_model(operation).input_shape.members
    for name, text in zip(arguments[2::2], arguments[3::2]):
        key = re.sub(r"-(.)", lambda match: match[1].upper(), name[2:])
        if name in ("--query", "--output"):
            continue
        if name == "--cli-input-json":
            given.update(json.load(open(text.removeprefix("file://"))))
            continue
        expect(key in members, f"{operation} has no {name}")
        kind = members[key].type_name
        value = text if kind == "string" else value_of(text)
        if key == "arrayProperties":
            value = {"size": int(value["size"])}
        given[key] = [value] if kind == "list" else value
    return operation, given


def main():
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/aws", "w") as file:
            file.write(AWS)
        os.chmod(f"{folder}/aws", 0o755)
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "NOTED": f"{folder}/noted"}
        subprocess.run([f"{FOLDER}/batch.sh", "spot", "16", "/tiles/city.osm.pbf", "/tiles/city.pmtiles", "15"],
                       check=True, env=environment, stdout=subprocess.DEVNULL)
        with open(f"{folder}/noted") as file:
            asked = [request_of(json.loads(line)) for line in file]
    for operation, given in asked:
        check(operation, given)
    expect([operation for operation, _ in asked] == ["RegisterJobDefinition"] + 3 * ["SubmitJob"], asked)
    definition, schedule, array, merge = (given for _, given in asked)
    command = definition["containerProperties"]["command"]
    wanted = {word.removeprefix("Ref::") for word in command if word.startswith("Ref::")}
    expect(wanted == set(definition["parameters"]) == set(array["parameters"]), f"parameters: {wanted}")
    expect(len(definition["retryStrategy"]["evaluateOnExit"]) <= 5, "Batch takes five conditions")
    expect(array["arrayProperties"]["size"] == int(array["parameters"]["shards"]), "--shards is not the array's size")
    look = schedule["containerOverrides"]["command"][2].split()
    expect(look[-4:] == ["--dry-run", "--schedule", "/tiles/city.pmtiles.schedule", "--force"] and
           array["parameters"]["schedule"] in look, f"the schedule is another one: {look}")
    expect(array["dependsOn"][0]["jobId"].startswith("job-"), "the array does not wait for the schedule")
    expect(merge["dependsOn"][0]["jobId"].startswith("job-"), "the merge does not wait for the array")
    expect("/tiles/city.*-of-16.pmtiles" in merge["containerOverrides"]["command"][2], "the merge takes other parts")
    try:
        check("RegisterJobDefinition", {**definition, "retries": 5})
    except SystemExit:
        return
    sys.exit("FAILED: a field that is not there is not told")


main()
