"""The findings as text, JSON and SARIF, the list of codes, and the exit codes of the command."""

from __future__ import annotations

import json
import re

import pytest
from command_line import main

from harness.check import RULES, SEVERITIES, Finding, report

FOUND = [
    Finding("HS401", 'there is no "a.png"', "correct it", "some folder/project.sprj", 12),
    Finding("HS110", "it is not guarded", "guard it", "/abs/a.frag", None),
    Finding("HS102", "a blank line", "remove it", "a.frag", 2, "warning"),
]


def test_text_has_a_place_a_reason_and_a_fix_for_each():
    text = report.text(FOUND)
    assert text.startswith('some folder/project.sprj:12: error HS401: there is no "a.png"\n    why: ')
    assert "/abs/a.frag: note HS110: it is not guarded\n" in text
    assert text.count("    fix: ") == len(FOUND)
    assert text.endswith("1 error, 1 warning, 1 note\n")
    assert "\033" not in text
    assert re.sub(r"\033\[\d+m", "", report.text(FOUND, color=True)) == text
    assert report.text([]) == "nothing found\n"


def test_json_has_the_documented_members(root):
    made = json.loads(report.as_json("p.sprj", FOUND))
    assert made["version"] == 1 and made["project"] == "p.sprj"
    assert made["counts"] == {"error": 1, "warning": 1, "note": 1}
    documented = set(re.findall(r"^\| `(\w+)` \|", (root / "docs" / "check.md").read_text(), re.MULTILINE))
    assert documented == {*made, *made["findings"][0]}
    assert made["findings"][1]["line"] is None
    assert all(f["severity"] in SEVERITIES for f in made["findings"])


def test_sarif_has_the_members_that_its_standard_requires():
    """OASIS, "Static Analysis Results Interchange Format (SARIF) Version 2.1.0", 2020: 3.13, 3.14, 3.18-19, 3.27-30,
    3.49; and that every index and place in it holds."""
    log = json.loads(report.as_sarif(FOUND, "1.2"))
    assert log["version"] == "2.1.0" and log["$schema"].endswith("sarif-2.1.0.json")
    (run,) = log["runs"]
    driver = run["tool"]["driver"]
    assert driver["name"] and driver["version"] == "1.2"
    ids = [rule["id"] for rule in driver["rules"]]
    assert len(set(ids)) == len(ids)
    assert all(rule["shortDescription"]["text"] for rule in driver["rules"])
    assert len(run["results"]) == len(FOUND)
    for result, finding in zip(run["results"], FOUND, strict=True):
        assert ids[result["ruleIndex"]] == result["ruleId"] == finding.code
        assert result["level"] == finding.severity and result["level"] in ("none", "note", "warning", "error")
        assert finding.message in result["message"]["text"]
        (location,) = result["locations"]
        assert location["physicalLocation"]["artifactLocation"]["uri"]
    places = [r["locations"][0]["physicalLocation"] for r in run["results"]]
    assert places[0] == {"artifactLocation": {"uri": "some%20folder/project.sprj"}, "region": {"startLine": 12}}
    assert places[1] == {"artifactLocation": {"uri": "file:///abs/a.frag"}}


def test_every_code_is_listed_and_documented(root):
    assert all(re.fullmatch(r"HS[0-6]\d\d", code) and rule.severity in SEVERITIES for code, rule in RULES.items())
    listed = report.rules().split("\n")
    assert [line.split()[0] for line in listed] == list(RULES)
    documented = re.findall(
        r"^\| (HS\d{3}) \| (\w+) \| (.*) \|$", (root / "docs" / "check.md").read_text(), re.MULTILINE
    )
    assert documented == [(code, rule.severity, rule.title) for code, rule in RULES.items()]


def test_every_code_has_a_test(root):
    folder = root / "tests" / "harness" / "check"
    subjects = ("structure", "shaders", "uniforms", "samplers", "textures", "models", "features")
    tests = "".join((folder / f"test_check_{subject}.py").read_text() for subject in subjects)
    assert [code for code in RULES if f'"{code}"' not in tests] == []


# ---- The command -----------------------------------------------------------------------------------------------------


def run(scene, *arguments) -> int:
    return main(["check", str(scene.project), *arguments])


def test_exit_code_0_without_findings(scene, capfd):
    assert run(scene, "--strict") == 0
    assert capfd.readouterr().out == "nothing found\n"


def test_exit_code_1_with_an_error(scene, capfd):
    scene.replace("shaders/backdrop.frag", "smoothstep", "smoothstop")
    assert run(scene) == 1
    done = capfd.readouterr()
    assert "backdrop.frag:18: error HS103: " in done.out and done.err == ""


def test_warnings_make_the_exit_code_1_only_with_strict(scene, capfd):
    scene.replace("project.sprj", "<distance>15<", "<distance>80<")
    assert run(scene) == 0
    assert run(scene, "--strict") == 1


@pytest.mark.parametrize("format", ["json", "sarif"])
def test_formats_for_machines(scene, capfd, format):
    scene.replace("project.sprj", "<distance>15<", "<distance>80<")
    assert run(scene, "--format", format) == 0
    made = json.loads(capfd.readouterr().out)
    codes = (
        [f["code"] for f in made["findings"]] if format == "json" else [r["ruleId"] for r in made["runs"][0]["results"]]
    )
    assert codes == ["HS011"]


def test_explain(capfd):
    assert main(["check", "--explain", "HS503"]) == 0
    assert capfd.readouterr().out.startswith("HS503 (warning): " + RULES["HS503"].title)
    assert main(["check", "--explain", "all"]) == 0
    assert capfd.readouterr().out == report.rules() + "\n"
    assert main(["check", "--explain", "HS999"]) == 1
    assert "there is no code HS999" in capfd.readouterr().err


def test_a_project_that_is_not_there(tmp_path, capfd):
    assert main(["check", str(tmp_path / "gone.sprj")]) == 1
    assert "gone.sprj: error HS001: cannot read the project" in capfd.readouterr().out
