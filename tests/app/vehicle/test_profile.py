"""Profiles: those of the package, and what is wrong in others."""

import pytest
from pydantic import ValidationError

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.fsm import load_grammar
from lightgesture.sinks.mavlink_map import COMMANDS
from lightgesture.vehicle.opening import open_runner
from lightgesture.vehicle.profile import ParameterTable
from lightgesture.vehicle.profile_file import BUNDLED, load_vehicle
from lightgesture.vehicle.task import plan_for

HEAD = 'name = "T"\n[modes]\nA = 1\n'
ACTION = '[[instruction]]\naction = "HOVER"\n'
STEPS = "steps = [{wait = 1}]\n"
PARAMETER = '[[parameter]]\nnumber = 1\nname = "cap"\nstep = 1\n'


@pytest.mark.parametrize("name", BUNDLED)
def test_bundled_profiles_know_the_tasks_of_the_bundled_language(name, instruction):
    profile = load_vehicle(name)
    known = {table.action for table in profile.instruction}
    assert {"HOVER", "UP", "DOWN", "LEFT", "RIGHT", "SNAP"} <= known
    assert profile.safety.stale_s == 1.0
    assert profile.stick.cap <= 0.5
    for table in profile.instruction:
        assert not isinstance(plan_for(instruction(f"STOP {table.action} 1 GO"), profile, "MANUAL"), str)


def test_parameters_of_the_bundled_profile_are_those_of_the_bundled_grammar():
    grammar = load_grammar()
    assert {table.number for table in load_vehicle("ardusub").parameter} <= set(grammar.parameters)


def test_no_step_arms():
    assert not any("ARM" in name.replace("PARAM", "") for name in COMMANDS)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (
            HEAD + ACTION + 'steps = [{mode = ["B"]}]\n',
            "instruction HOVER: B is no mode of this profile; use A",
        ),
        (HEAD + ACTION + "steps = [{mission = 1}]\n", "AUTO is no mode of this profile"),
        (
            HEAD + '[safety]\nfault_modes = ["B"]\n' + ACTION + "steps = [{wait = 1}]\n",
            "safety.fault_modes: B is no mode of this profile; use A",
        ),
        (HEAD + ACTION + "steps = [{}]\n", "a step has exactly one of mode, stick, wait, command"),
        (HEAD + ACTION + 'steps = [{wait = 1, hook = "a"}]\n', "a step has exactly one of"),
        (HEAD + ACTION + "steps = []\n", "steps: List should have at least 1 item"),
        (HEAD + ACTION + "steps = [{wait = 1, sconds = 2}]\n", "sconds: unknown key"),
        (HEAD + ACTION + "steps = [{stick = {u = 1}}]\n", "Input should be 'x', 'y', 'z' or 'r'"),
        (HEAD + ACTION + "steps = [{stick = {z = 1.1}}]\n", "less than or equal to 1"),
        (HEAD + ACTION + "steps = [{stick = {z = 1}, seconds = 0}]\n", "greater than 0"),
        (
            HEAD + ACTION + 'steps = [{command = "MAV_CMD_COMPONENT_ARM_DISARM"}]\n',
            "MAV_CMD_COMPONENT_ARM_DISARM is not permitted; permitted are",
        ),
        (HEAD + ACTION + "steps = [{mission = 5, last = 2, mode = 'A'}]\n", "last 2 comes before mission 5"),
        (HEAD + ACTION + "steps = [{camera = 0}]\n", "no picture would be taken"),
        (HEAD + ACTION + 'steps = [{hook = "no-such-program"}]\n', "hook no-such-program: no such command"),
        (
            HEAD + "[safety]\nstale_s = 1.5\n" + ACTION + "steps = [{wait = 1}]\n",
            "safety.stale_s: Input should be",
        ),
        (HEAD + "[link]\ntimeot_s = 3\n" + ACTION + "steps = [{wait = 1}]\n", "did you mean 'timeout_s'?"),
        (HEAD + "[stick]\nrate_hz = 2\n" + ACTION + "steps = [{wait = 1}]\n", "stick.rate_hz"),
        ("colour = 1\n" + HEAD + ACTION + "steps = [{wait = 1}]\n", "colour: unknown key"),
        (HEAD + (ACTION + "steps = [{wait = 1}]\n") * 2, "instruction HOVER stands twice"),
        (HEAD, "instruction: Field required"),
        (
            HEAD + ACTION + STEPS + PARAMETER + "minimum = 2\nmaximum = 3\ndefault = 1\n",
            "default 1 is not from minimum 2 to maximum 3",
        ),
        (
            HEAD + ACTION + STEPS + PARAMETER + "own = true\nminimum = 0\nmaximum = 2\ndefault = 1\n",
            "cap may go from 0.05 to 1",
        ),
        ("name = \n", "TOML syntax"),
    ],
)
def test_profiles_that_are_wrong(tmp_path, text, reason):
    path = tmp_path / "vehicle.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        load_vehicle(str(path))
    assert str(caught.value).startswith(f"{path}: ")
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_no_profile_and_no_link(tmp_path):
    with pytest.raises(UsageError, match="no such file; name an existing profile of a vehicle"):
        load_vehicle(str(tmp_path / "none.toml"))
    with pytest.raises(UsageError, match="--obey: there is no link to a vehicle; name it by --mavlink"):
        open_runner(DecodeSettings(obey="ardusub"), None, None, None, None)


def test_a_program_of_its_own_goes_before_any_program(tmp_path, instruction):
    path = tmp_path / "vehicle.toml"
    path.write_text(
        HEAD + '[[instruction]]\naction = "EXEC"\nsteps = [{wait = 1}]\n'
        '[[instruction]]\naction = "EXEC"\nprogram = 2\nsteps = [{wait = 2}]\n'
    )
    profile = load_vehicle(str(path))
    waits = [profile.table_for(instruction(f"STOP EXEC {number} GO")).steps[0].wait for number in (1, 2, 3)]
    assert waits == [1, 2, 1]


@pytest.mark.parametrize(
    ("name", "own", "minimum", "maximum", "default", "is_right"),
    [
        ("SPEED", False, 2, 5, 2, True),
        ("SPEED", False, 2, 5, 5, True),
        ("SPEED", False, 2, 5, 1.9, False),
        ("SPEED", False, 2, 5, 5.1, False),
        ("SPEED", False, -900, 900, 0, True),
        ("cap", True, 0.05, 1.0, 0.4, True),
        ("cap", True, 0.04, 1.0, 0.4, False),
        ("cap", True, 0.05, 1.01, 0.4, False),
        ("cap", False, 0.0, 9.0, 0.4, True),  # the vehicle's own of that name
        ("speed", True, 0.1, 1.0, 0.4, False),
    ],
)
def test_limits_of_parameters(name, own, minimum, maximum, default, is_right):
    fields = {"number": 1, "name": name, "own": own, "step": 0.1}
    fields |= {"minimum": minimum, "maximum": maximum, "default": default}
    if is_right:
        assert ParameterTable(**fields).default == default
    else:
        with pytest.raises(ValidationError):
            ParameterTable(**fields)
