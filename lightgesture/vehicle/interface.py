"""The seam between the executor and a vehicle: what it is told to do, what it answers, and what is known of it.

Nothing here waits. The executor calls `Vehicle.poll` some twenty times a second; an order is answered in its
`Reply`, which the vehicle fills in during later polls. All times are seconds of one steady clock that the caller
hands in, so that a simulation can bring its own.
"""

from dataclasses import dataclass, field
from typing import Final, Literal, Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class Stick:
    """Where the sticks are, each -1 to 1 of their way: x forward, y to the right, z up, r clockwise seen from above."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    r: float = 0.0

    def scaled(self, share: float) -> "Stick":
        """The same direction, `share` of the way."""
        return Stick(x=self.x * share, y=self.y * share, z=self.z * share, r=self.r * share)

    @property
    def largest(self) -> float:
        """The longest way of a stick from its middle, 0 to 1."""
        return max(abs(self.x), abs(self.y), abs(self.z), abs(self.r))


NEUTRAL: Final = Stick()
"""All sticks in the middle: the vehicle gets no push from us."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SetMode:
    """Enter the first of these modes that the vehicle takes. names: those of the profile's `[modes]`."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class SendCommand:
    """A COMMAND_LONG. command: its number; name: for messages; params: all seven; component: whom it is for."""

    name: str
    command: int
    params: tuple[float, ...]
    component: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SendValue:
    """A named value for the vehicle's own program; nobody answers it, so that it counts as accepted once it is sent."""

    name: str
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadParameter:
    """The value of a parameter, in `Reply.value`."""

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class WriteParameter:
    """Set a parameter and read it back; refused where another value comes back."""

    name: str
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class StartMission:
    """Run the loaded mission from item `first`, in the mode `mode`; refused where item `first` or `last` is not loaded.

    last: after it the part is done; None: the last one that is loaded. `Reply.value` becomes the number of that item.
    """

    first: int
    last: int | None
    mode: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TakePictures:
    """Have a camera take `count` pictures, one each `interval_s` seconds."""

    component: int
    interval_s: float
    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class StopPictures:
    """Have a camera take no more pictures."""

    component: int


Order = (
    SetMode
    | SendCommand
    | SendValue
    | ReadParameter
    | WriteParameter
    | StartMission
    | TakePictures
    | StopPictures
)
"""What a vehicle can be told, besides where the sticks are."""

ReplyState = Literal["pending", "accepted", "refused"]


@dataclass(slots=True)
class Reply:
    """What became of an order, filled in by the vehicle.

    detail: why it was refused, or what was done in its place. value: a parameter's value, the last item of a
    mission. progress: percent, where the vehicle tells.
    """

    state: ReplyState = "pending"
    detail: str = ""
    value: float | None = None
    progress: int | None = None

    def accept(self, detail: str = "", value: float | None = None) -> None:
        """It is done, or begun."""
        self.state, self.detail = "accepted", detail
        self.value = self.value if value is None else value

    def refuse(self, detail: str) -> None:
        """It is not done."""
        self.state, self.detail = "refused", detail


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A picture that a camera of the vehicle says it took: its number there, and where it lies, where that is told."""

    number: int
    place: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What is known of the vehicle at one moment; times are of the caller's clock, None: never.

    heard_s: its last heartbeat. mode: its name in the profile, its number as text where that lacks it, "" before the
    first heartbeat. foreign_modes: how often the mode changed that nobody here had ordered. boots: how often it was
    seen to start anew. pilot_s: when another's stick was last away from its middle. stick_s: when any stick of
    another was last heard. rival_s: when another program with our own number was last heard. trouble: why it cannot be
    told anything, such as two vehicles on the link; "" where it can. item: the last item of the mission that was
    reached. pictures: those that were taken since the last poll.
    """

    heard_s: float | None = None
    mode: str = ""
    foreign_modes: int = 0
    is_armed: bool = False
    boots: int = 0
    pilot_s: float | None = None
    stick_s: float | None = None
    rival_s: float | None = None
    trouble: str = ""
    item: int | None = None
    pictures: tuple[Picture, ...] = field(default=())


class Vehicle(Protocol):
    """A vehicle, as the executor sees it; all calls come from one thread, and none may wait."""

    def poll(self, now_s: float) -> Status:
        """Take in what the vehicle says, send again what it did not answer. pictures: those since the last poll."""
        ...

    def stick(self, stick: Stick, now_s: float) -> None:
        """Send where the sticks are, once. A link that is down swallows it."""
        ...

    def order(self, order: Order, now_s: float) -> Reply:
        """Send an order; the reply is filled in by later polls, and always at last. It replaces one that is pending and
        of the same kind, which is refused."""
        ...
