"""The vehicle's body in water, in MuJoCo: six thrusters, buoyancy above the weight, drag, a current.

MuJoCo's axes are x forward (north), y left (west), z up; all that leaves this module is north, east, down and
clockwise headings, as MAVLink has it. Drag and lift are MuJoCo's ellipsoid fluid model (its manual, "Fluid forces");
buoyancy is gravity compensation of a float that sits above the weight, which rights the body; the water that moves
along with the body is added to its inertia, the same in all directions. Sizes and thrusts are those of a BlueROV2.
"""

from __future__ import annotations

import importlib
import math
import os
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import UsageError

Array = NDArray[np.float64]

STEP_S: Final = 0.005
"""Of the physics, seconds."""

THRUSTERS: Final = 6


@dataclass(frozen=True, slots=True)
class BodySpec:
    """What the vehicle is; the effect of each value beside it."""

    mass_kg: float = 11.5
    """Weight that the float carries, above 0."""
    added_kg: float = 8.0
    """Water that moves along, from 0: more is slower to start and to stop."""
    float_m: float = 0.06
    """The float's height above the weight, above 0: higher rights the vehicle more strongly."""
    excess_n: float = 1.0
    """Buoyancy beyond the weight, newtons: above 0 it rises by itself when the thrusters are off."""
    size_m: tuple[float, float, float] = (0.457, 0.338, 0.254)
    """Length, width, height."""
    thrust_n: float = 40.0
    """Most thrust of each thruster either way, newtons."""
    lag_s: float = 0.12
    """Time constant of a thruster, seconds."""
    current_mps: tuple[float, float] = (0.0, 0.0)
    """Of the water, north and east, metres a second."""


@dataclass(frozen=True, slots=True)
class Motion:
    """Where the vehicle is: north, east, down (m), their rates (m/s); roll, pitch, yaw and their rates (rad, rad/s).

    Down is the depth of its middle below the surface; yaw 0 looks north, positive turns clockwise seen from above.
    """

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    attitude: tuple[float, float, float]
    rates: tuple[float, float, float]

    @property
    def depth_m(self) -> float:
        return self.position[2]

    @property
    def heading_deg(self) -> float:
        """0 to 360."""
        return math.degrees(self.attitude[2]) % 360.0


def import_mujoco() -> Any:
    """MuJoCo, set to draw without a display where nobody asked otherwise. UsageError: it is not installed."""
    os.environ.setdefault("MUJOCO_GL", "egl")
    try:
        return importlib.import_module("mujoco")
    except ImportError as error:
        raise UsageError(f"simulate: mujoco is not installed ({error}); install lightgesture[sim]") from None


# Place (m, forward, left, up) and direction of each thruster's push. Four stand across the corners, two push up.
_ACROSS = math.sqrt(0.5)
LAYOUT: Final = (
    ((0.16, -0.11, 0.0), (_ACROSS, _ACROSS, 0.0)),
    ((0.16, 0.11, 0.0), (_ACROSS, -_ACROSS, 0.0)),
    ((-0.16, -0.11, 0.0), (_ACROSS, -_ACROSS, 0.0)),
    ((-0.16, 0.11, 0.0), (_ACROSS, _ACROSS, 0.0)),
    ((0.0, -0.11, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 0.11, 0.0), (0.0, 0.0, 1.0)),
)


def thruster_matrix() -> Array:
    """Force and torque (6, thrusters), body axes, of one newton of each thruster."""
    columns = [np.concatenate([push, np.cross(place, push)]) for place, push in LAYOUT]
    return np.stack(columns, axis=1)


def model_text(spec: BodySpec, diver_m: tuple[float, float, float]) -> str:
    """The pool in MuJoCo's format. diver_m: where the diver's shoulders are, north, east, down."""
    length, width, height = (0.5 * side for side in spec.size_m)
    float_kg = 0.05 * spec.mass_kg
    hull_kg = spec.mass_kg + spec.added_kg - float_kg
    weight_kg = hull_kg + float_kg
    lift = (weight_kg + spec.excess_n / 9.81) / float_kg
    sites = "\n".join(
        f'<site name="t{index}" pos="{place[0]} {place[1]} {place[2]}" type="cylinder" size=".035 .04" '
        f'zaxis="{push[0]} {push[1]} {push[2]}" rgba=".15 .15 .15 1"/>'
        for index, (place, push) in enumerate(LAYOUT)
    )
    pushes = "\n".join(
        f'<general site="t{index}" gear="0 0 {spec.thrust_n} 0 0 0" ctrlrange="-1 1" ctrllimited="true" '
        f'dyntype="filter" dynprm="{spec.lag_s}"/>'
        for index in range(THRUSTERS)
    )
    north, east, down = diver_m
    return f"""
<mujoco model="pool">
  <option timestep="{STEP_S}" integrator="implicitfast" density="1000" viscosity="0.001"
    wind="{spec.current_mps[0]} {-spec.current_mps[1]} 0"/>
  <visual><headlight ambient=".45 .45 .45" diffuse=".4 .4 .4"/><global offwidth="640" offheight="480"/>
    <quality offsamples="0" shadowsize="0"/>
    <rgba fog=".05 .32 .42 1"/><map fogstart="4" fogend="14"/></visual>
  <asset>
    <texture name="tiles" type="2d" builtin="checker" rgb1=".25 .55 .62" rgb2=".2 .48 .56" width="64" height="64"/>
    <material name="tiles" texture="tiles" texrepeat="30 30" reflectance="0"/>
    <texture name="water" type="skybox" builtin="gradient" rgb1=".1 .42 .52" rgb2=".02 .16 .24" width="64" height="64"/>
  </asset>
  <default><default class="shown"><geom contype="0" conaffinity="0"/></default></default>
  <worldbody>
    <light pos="0 0 3" dir="0 .2 -1" directional="true" diffuse=".5 .55 .55"/>
    <geom name="floor" type="plane" size="15 15 .1" pos="0 0 -5" material="tiles"/>
    <geom type="plane" size="15 15 .1" pos="0 0 0" rgba=".5 .8 .9 .12" class="shown"/>
    <body name="diver" mocap="true" pos="{north} {-east} {-down}">
      <geom type="capsule" size=".15" fromto="0 0 -.45 0 0 0" rgba=".05 .05 .07 1" class="shown"/>
      <geom type="sphere" size=".12" pos="0 0 .27" rgba=".75 .55 .45 1" class="shown"/>
      <geom type="capsule" size=".05" fromto="0 .2 0 -.22 .3 .07" rgba=".05 .05 .07 1" class="shown"/>
      <geom type="capsule" size=".05" fromto="0 -.2 0 -.22 -.3 .07" rgba=".05 .05 .07 1" class="shown"/>
      <geom type="capsule" size=".07" fromto="0 .09 -.5 .1 .1 -1.25" rgba=".05 .05 .07 1" class="shown"/>
      <geom type="capsule" size=".07" fromto="0 -.09 -.5 .1 -.1 -1.25" rgba=".05 .05 .07 1" class="shown"/>
    </body>
    <body name="vehicle" pos="0 0 -2">
      <freejoint/>
      <geom name="hull" type="box" size="{length} {width} {0.6 * height}" mass="{hull_kg}" rgba=".1 .25 .75 1"
        fluidshape="ellipsoid" fluidcoef="1.1 .6 2.5 .2 .2"/>
      <geom type="cylinder" size=".06 .2" euler="0 90 0" pos="0 0 .02" mass="0" rgba=".85 .85 .85 1"/>
      <geom type="sphere" size=".06" pos="{length} 0 .02" mass="0" rgba=".1 .1 .1 1"/>
      {sites}
      <body name="float" gravcomp="{lift}" pos="0 0 {spec.float_m}">
        <geom type="box" size="{0.8 * length} {0.8 * width} .04" mass="{float_kg}" rgba=".95 .75 .1 1"
          fluidshape="ellipsoid" fluidcoef="0 0 0 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator>{pushes}</actuator>
</mujoco>"""


class Body:
    """The vehicle in the water, stepped by `advance`; `model` and `data` are MuJoCo's, for who draws."""

    def __init__(
        self,
        spec: BodySpec | None = None,
        depth_m: float = 2.0,
        diver_m: tuple[float, float, float] = (1.5, 0.0, 2.0),
    ) -> None:
        self.spec = spec or BodySpec()
        self._mujoco = import_mujoco()
        self.model = self._mujoco.MjModel.from_xml_string(model_text(self.spec, diver_m))
        self.data = self._mujoco.MjData(self.model)
        self.data.qpos[2] = -depth_m
        self._mujoco.mj_forward(self.model, self.data)
        self._vehicle = self.model.body("vehicle").id
        self._dry_gravity = self.model.body_gravcomp.copy()

    @property
    def time_s(self) -> float:
        """Seconds of the physics since the start."""
        return float(self.data.time)

    def advance(self, until_s: float, commands: Array) -> None:
        """Step to a time with the six thrusters at `commands`, each -1 to 1."""
        self.data.ctrl[:] = np.clip(commands, -1.0, 1.0)
        while self.data.time < until_s - 0.5 * STEP_S:
            # Above the surface nothing carries: what rises out of the water weighs on it again.
            out_m = float(np.clip(self.data.qpos[2] / 0.1, 0.0, 1.0))
            self.model.body_gravcomp[:] = self._dry_gravity * (1.0 - out_m)
            self._mujoco.mj_step(self.model, self.data)

    def place_diver(self, north_m: float, east_m: float, down_m: float) -> None:
        """Put the figure of the diver, which touches nothing, to a place."""
        self.data.mocap_pos[0] = (north_m, -east_m, -down_m)

    def motion(self) -> Motion:
        """Position, attitude and their rates now."""
        x, y, z = (float(value) for value in self.data.qpos[:3])
        vx, vy, vz = (float(value) for value in self.data.qvel[:3])
        p, q, r = (float(value) for value in self.data.qvel[3:6])
        turn = self.data.xmat[self._vehicle].reshape(3, 3)
        roll = math.atan2(turn[2, 1], turn[2, 2])
        pitch = -math.asin(float(np.clip(-turn[2, 0], -1.0, 1.0)))
        yaw = -math.atan2(turn[1, 0], turn[0, 0])
        return Motion((x, -y, -z), (vx, -vy, -vz), (roll, pitch, yaw), (p, -q, -r))
