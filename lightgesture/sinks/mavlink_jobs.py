"""What is asked of a vehicle until it is answered: sent again where nothing comes, given up at last."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Final

from lightgesture.sinks.mavlink_link import Link
from lightgesture.sinks.mavlink_peer import Peer
from lightgesture.vehicle.interface import Reply, SendCommand

ANSWER_S: Final = 0.7
"""Seconds until what was not answered is sent again."""

TRIES: Final = 4
"""How often it is sent at most."""

PROGRESS_S: Final = 10.0
"""Seconds after the last word of a command that is in progress when it counts as failed."""

NO_ANSWER: Final = "no answer"
UNSUPPORTED: Final = "unsupported"

RESULTS: Final = {
    1: "temporarily rejected",
    2: "denied",
    3: UNSUPPORTED,
    4: "failed",
    6: "cancelled",
    7: "wants a COMMAND_LONG only",
    8: "wants a COMMAND_INT only",
    9: "wrong frame",
}
"""What a COMMAND_ACK says, but for 0, accepted, and 5, in progress."""

_ACCEPTED, _IN_PROGRESS = 0, 5


@dataclass(frozen=True, slots=True)
class Talk:
    """Who speaks to whom on which link, and with how much patience."""

    link: Link
    peer: Peer
    answer_s: float = ANSWER_S
    tries: int = TRIES
    progress_s: float = PROGRESS_S

    @property
    def dialect(self) -> Any:
        """pymavlink's messages and numbers."""
        return self.link.dialect

    def send(self, message: Any) -> None:
        """As the vehicle's companion. SinkError: the link is dead."""
        self.link.send(message, self.peer.system, self.peer.component)

    def is_from(self, message: Any, component: int) -> bool:
        """Whether a message is from a component of the vehicle, 0 being any."""
        return message.get_srcSystem() == self.peer.system and component in (0, message.get_srcComponent())

    def is_for_us(self, message: Any) -> bool:
        """Whether an answer is for us, or does not say for whom."""
        return message.target_system in (0, self.peer.system) and message.target_component in (
            0,
            self.peer.component,
        )


class Job(ABC):
    """One thing that is asked; `reply` tells what became of it. kind: what a newer one of the same kind replaces."""

    def __init__(self, talk: Talk) -> None:
        self.talk = talk
        self.reply = Reply()

    @property
    @abstractmethod
    def kind(self) -> tuple[object, ...]: ...

    @abstractmethod
    def note(self, message: Any, now_s: float) -> None:
        """Look at a message that came."""

    @abstractmethod
    def poll(self, now_s: float) -> None:
        """Send, again where it is time, or give up. SinkError: the link is dead."""

    @property
    def is_done(self) -> bool:
        """Whether nothing more is to be done."""
        return self.reply.state != "pending"


class Repeated(Job):
    """Something that is sent until it is answered. Who derives from it has `message` and calls `stop` at the answer."""

    def __init__(self, talk: Talk) -> None:
        super().__init__(talk)
        self.sent = 0
        self.due_s = float("-inf")

    @abstractmethod
    def message(self) -> Any:
        """What is sent; `sent` counts how often it was already."""

    def poll(self, now_s: float) -> None:
        """Send, again where it is time, or give up."""
        if self.is_done or now_s < self.due_s:
            return
        if self.sent >= self.talk.tries:
            self.give_up()
            return
        self.talk.send(self.message())
        self.sent += 1
        self.due_s = now_s + self.talk.answer_s

    def give_up(self) -> None:
        """Nothing came."""
        self.reply.refuse(f"{NO_ANSWER} to {self.sent} tries")


class CommandJob(Repeated):
    """A COMMAND_LONG until its COMMAND_ACK, each try with a higher `confirmation`.

    A command that is in progress is not sent again: it has time until `progress_s` after the vehicle's last word.
    """

    def __init__(self, talk: Talk, order: SendCommand) -> None:
        super().__init__(talk)
        self._order = order
        self._is_in_progress = False
        self.result: int | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        return "command", self._order.command, self._order.component

    def message(self) -> Any:
        """The command, as it is sent next."""
        order, talk = self._order, self.talk
        return talk.dialect.MAVLink_command_long_message(
            talk.peer.system, order.component, order.command, self.sent, *order.params
        )

    def note(self, message: Any, now_s: float) -> None:
        """Heed the acknowledgement of this command, by whom it was sent to, for us."""
        is_answer = (
            message.get_type() == "COMMAND_ACK"
            and message.command == self._order.command
            and self.talk.is_from(message, self._order.component)
            and self.talk.is_for_us(message)
        )
        if not is_answer or self.is_done or not self.sent:
            return
        if message.result == _IN_PROGRESS:
            self._is_in_progress = True
            self.reply.progress = message.progress if message.progress <= 100 else None
            self.due_s = now_s + self.talk.progress_s
            return
        self.result = message.result
        if message.result == _ACCEPTED:
            self.reply.accept()
        else:
            self.reply.refuse(RESULTS.get(message.result, f"result {message.result}"))

    def poll(self, now_s: float) -> None:
        """As its base; one in progress that falls silent is given up."""
        if self._is_in_progress and not self.is_done:
            if now_s >= self.due_s:
                self.reply.refuse("in progress, then no further word")
            return
        super().poll(now_s)
