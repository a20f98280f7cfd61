"""The node of ROS 1, by `rospy`, which the user's own ROS brings."""

from collections.abc import Sequence
from typing import Any, Final

from lightgesture.config.settings import DecodeSettings
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.ros.listener import ANNOTATED, DIAGNOSTICS, NUMBER, STATE, TEXTS
from lightgesture.ros.running import IMAGE, NAME, check, parameter_names, run_topic, settings_with
from lightgesture.ros.source import TopicSource

BUFFER_BYTES: Final = 1 << 24
"""Of the subscription: rospy keeps old pictures in a smaller one, whatever the length of its queue."""


def run_node(settings: DecodeSettings, is_raw: bool, words: Sequence[str]) -> ExitStatus:
    """Run the node until a signal ends it.

    words: remappings and parameters, `NAME:=VALUE`. UsageError: there is no rospy or no master, or an option or a
    parameter is wrong.
    """
    rospy = _import_rospy()
    from sensor_msgs.msg import CompressedImage, Image

    try:
        rospy.init_node(NAME, argv=[NAME, *words], disable_signals=True)
        given = {name: rospy.get_param(f"~{name}", None) for name in parameter_names()}
    except (rospy.ROSException, OSError) as error:
        raise UsageError(
            f"ros1: cannot reach the master ({error}); start roscore, set ROS_MASTER_URI"
        ) from None
    chosen = settings_with(settings, given)
    check(chosen)
    source = TopicSource(rospy.resolve_name(IMAGE[is_raw]), say)
    wire = Wire1(rospy)
    kind = Image if is_raw else CompressedImage
    subscription = rospy.Subscriber(IMAGE[is_raw], kind, source.put, queue_size=1, buff_size=BUFFER_BYTES)
    rospy.on_shutdown(source.end)
    try:
        return run_topic(chosen, source, wire)
    finally:
        subscription.unregister()
        rospy.signal_shutdown("the end")


def _import_rospy() -> Any:
    try:
        import rospy
    except ImportError as error:
        raise UsageError(
            f"ros1: rospy is not there ({error}); source your ROS 1 installation, and use a Python of its version"
        ) from None
    return rospy


class Wire1:
    """Publishes by rospy's publishers."""

    def __init__(self, rospy: Any) -> None:
        from sensor_msgs.msg import CompressedImage
        from std_msgs.msg import Int32, String

        self._rospy, self._image = rospy, CompressedImage
        self._texts = {
            name: rospy.Publisher(f"~{name}", String, queue_size=10, latch=name == STATE) for name in TEXTS
        }
        self._numbers = {NUMBER: rospy.Publisher(f"~{NUMBER}", Int32, queue_size=10)}
        self._pictures = rospy.Publisher(f"~{ANNOTATED}", CompressedImage, queue_size=1)
        self._health, self._health_types = self._make_health()

    @property
    def is_watched(self) -> bool:
        """Whether somebody subscribes to the annotated pictures."""
        return bool(self._pictures.get_num_connections())

    def text(self, name: str, value: str) -> None:
        """Publish a text."""
        self._publish(self._texts[name], value)

    def number(self, name: str, value: int) -> None:
        """Publish a number."""
        self._publish(self._numbers[name], value)

    def picture(self, jpeg: bytes, header: Any) -> None:
        """Publish an annotated picture under the header of the one that it was made of."""
        message = self._image(format="jpeg", data=jpeg)
        if header is not None:
            message.header = header
        self._publish(self._pictures, message)

    def diagnostics(self, level: int, message: str, values: dict[str, str]) -> None:
        """Publish the health of the node, where diagnostic_msgs is installed."""
        if self._health is None:
            return
        health, status, pair = self._health_types
        pairs = [pair(key=key, value=value) for key, value in values.items()]
        name = f"{self._rospy.get_name().strip('/')}: decoder"
        content = health(status=[status(level=level, name=name, message=message, values=pairs)])
        content.header.stamp = self._rospy.Time.now()
        self._publish(self._health, content)

    def _publish(self, publisher: Any, content: Any) -> None:
        try:
            publisher.publish(content)
        except self._rospy.ROSException:  # the node ends
            return

    def _make_health(self) -> tuple[Any, tuple[Any, Any, Any]]:
        try:
            from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
        except ImportError:
            say("ros1: diagnostic_msgs is not installed; nothing is published on /diagnostics")
            return None, (None, None, None)
        publisher = self._rospy.Publisher(DIAGNOSTICS, DiagnosticArray, queue_size=1)
        return publisher, (DiagnosticArray, DiagnosticStatus, KeyValue)
