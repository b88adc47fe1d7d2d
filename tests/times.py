#!/usr/bin/env python3
"""Prints where the time of a check went, and writes it as CSV.

    tests/times.py STAGES.csv BUILD...       BUILD: a build folder whose tests have run

STAGES.csv holds a line `name,seconds` for each stage. Of each build folder the suites come from
Testing/suites.xml (ctest --output-junit) and the single tests from Testing/cases/*.xml
(GTEST_OUTPUT); a suite that is no GoogleTest program counts as one test. The CSV,
`kind,name,seconds`, is written beside STAGES.csv as times.csv.
"""
import csv
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

SLOWEST = 20


def suites_of(build):
    """Names and wall seconds of the suites, the longest first."""
    file = build / "Testing" / "suites.xml"
    if not file.exists():
        return []
    suites = [(case.get("name"), float(case.get("time", 0)))
              for case in ElementTree.parse(file).getroot().iter("testcase")
              if case.get("status") != "disabled"]
    return sorted(suites, key=lambda suite: -suite[1])


def cases_of(build, suites):
    cases = []
    for suite, seconds in suites:
        file = build / "Testing" / "cases" / f"{suite}.xml"
        if not file.exists():
            cases.append((suite, seconds))
            continue
        for case in ElementTree.parse(file).getroot().iter("testcase"):
            name = f'{suite}: {case.get("classname")}.{case.get("name")}'
            cases.append((name, float(case.get("time", 0))))
    return sorted(cases, key=lambda case: -case[1])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    stages_file = pathlib.Path(sys.argv[1])
    with open(stages_file, newline="") as file:
        stages = [(name, float(seconds)) for name, seconds in csv.reader(file)]
    rows = [("stage", name, seconds) for name, seconds in stages]

    print(f"\n{'minutes':>8}  stage")
    for name, seconds in stages:
        print(f"{seconds / 60:8.1f}  {name}")
    print(f"{sum(seconds for _, seconds in stages) / 60:8.1f}  all")

    for build in map(pathlib.Path, sys.argv[2:]):
        suites = suites_of(build)
        if not suites:
            continue
        cases = cases_of(build, suites)
        rows += [("suite", f"{build.name}/{name}", seconds) for name, seconds in suites]
        rows += [("test", f"{build.name}/{name}", seconds) for name, seconds in cases]
        total = sum(seconds for _, seconds in suites)
        print(f"\n{'seconds':>8}  {build.name}: {len(suites)} suites, {total / 60:.1f} minutes one after another")
        for name, seconds in suites:
            print(f"{seconds:8.1f}  {name}")
        print(f"\n{'seconds':>8}  {build.name}: the slowest of {len(cases)} tests")
        for name, seconds in cases[:SLOWEST]:
            print(f"{seconds:8.1f}  {name}")

    with open(stages_file.parent / "times.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("kind", "name", "seconds"))
        writer.writerows((kind, name, f"{seconds:.2f}") for kind, name, seconds in rows)
    print(f"\nall of them: {stages_file.parent / 'times.csv'}")


if __name__ == "__main__":
    main()
