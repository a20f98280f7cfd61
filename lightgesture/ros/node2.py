"""The node of ROS 2: a managed node by `rclpy`, which the user's own ROS brings."""

import threading
from array import array
from collections.abc import Sequence
from typing import Any, Final

from lightgesture.config.settings import DecodeSettings
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.interruption import stop_signals
from lightgesture.ros.listener import ANNOTATED, DIAGNOSTICS, NUMBER, STATE, TEXTS
from lightgesture.ros.running import IMAGE, NAME, check, parameter_names, run_topic, settings_with
from lightgesture.ros.source import TopicSource

RAW: Final = "raw"
"""Parameter that says whether pictures are subscribed raw."""

SPIN_S: Final = 0.1
"""How late the end of the node is heeded, seconds."""


def run_node(settings: DecodeSettings, is_raw: bool, is_managed: bool, words: Sequence[str]) -> ExitStatus:
    """Run the node until a signal or a transition ends it.

    is_managed: wait for the transitions of a lifecycle manager; else it configures and activates itself. words: what
    stands from `--ros-args` on. UsageError: there is no rclpy, or an option or a parameter is wrong.
    """
    rclpy = _import_rclpy()
    try:
        rclpy.init(args=list(words), signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    except Exception as error:  # rclpy has one of its own for each kind of wrong word
        raise UsageError(f"--ros-args: {str(error).splitlines()[0]}; correct them") from None
    node = make_node(settings, is_raw)
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node.node)
    ending = threading.Event()
    spinner = threading.Thread(target=_spin, args=(executor, ending), name="rclpy", daemon=True)
    spinner.start()
    try:
        if not is_managed:
            node.start_by_itself()
        return _serve(node)
    finally:
        ending.set()
        spinner.join()
        executor.shutdown()
        node.node.destroy_node()
        rclpy.shutdown()


def _spin(executor: Any, ending: threading.Event) -> None:
    while not ending.is_set():
        executor.spin_once(SPIN_S)


def _serve(node: "GestureNode") -> ExitStatus:
    """Decode whenever the node is active, until a signal or its shutdown."""
    status = ExitStatus.OK
    while True:
        with stop_signals() as stopping:
            while not stopping.is_set() and not node.is_shut_down and node.run is None:
                node.changed.wait(SPIN_S)
                node.changed.clear()
            run = node.run
            if run is None or stopping.is_set() or node.is_shut_down:
                return ExitStatus.INTERRUPTED if stopping.is_interrupted else status
        status = run_topic(run.settings, run.source, node.wire)
        node.note_end(run)
        # A run that nobody ended by a transition was ended by a signal, or by itself for a reason that was told.
        if not run.is_deactivated:
            return status


def _import_rclpy() -> Any:
    try:
        import rclpy
        import rclpy.executors
        import rclpy.lifecycle
        import rclpy.signals
    except ImportError as error:
        raise UsageError(
            f"ros2: rclpy is not there ({error}); source your ROS 2 installation, and use a Python of its version"
        ) from None
    return rclpy


class Run:
    """One time of being active."""

    def __init__(self, settings: DecodeSettings, source: TopicSource) -> None:
        self.settings, self.source = settings, source
        self.is_deactivated = False

    def end(self) -> None:
        """By a transition."""
        self.is_deactivated = True
        self.source.end()


class Wire2:
    """Publishes by the publishers of a node; `TEXTS` and so on name them."""

    def __init__(self, node: Any) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
        from sensor_msgs.msg import CompressedImage
        from std_msgs.msg import Int32, String

        # An instruction must arrive, and must not be told to who comes later; the state is for who comes later too.
        once = QoSProfile(depth=10)
        last = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._node, self._string, self._int32, self._image = node, String, Int32, CompressedImage
        self._texts = {
            name: node.create_publisher(String, f"~/{name}", last if name == STATE else once)
            for name in TEXTS
        }
        self._numbers = {NUMBER: node.create_publisher(Int32, f"~/{NUMBER}", once)}
        self._pictures = node.create_publisher(CompressedImage, f"~/{ANNOTATED}", qos_profile_sensor_data)
        self._health, self._health_types = self._make_health(node)

    @property
    def is_watched(self) -> bool:
        """Whether somebody subscribes to the annotated pictures."""
        return bool(self._pictures.get_subscription_count())

    def text(self, name: str, value: str) -> None:
        """Publish a text."""
        self._texts[name].publish(self._string(data=value))

    def number(self, name: str, value: int) -> None:
        """Publish a number."""
        self._numbers[name].publish(self._int32(data=value))

    def picture(self, jpeg: bytes, header: Any) -> None:
        """Publish an annotated picture under the header of the one that it was made of."""
        message = self._image(format="jpeg", data=array("B", jpeg))
        if header is not None:
            message.header = header
        self._pictures.publish(message)

    def diagnostics(self, level: int, message: str, values: dict[str, str]) -> None:
        """Publish the health of the node, where diagnostic_msgs is installed."""
        if self._health is None:
            return
        health, status, pair = self._health_types
        pairs = [pair(key=key, value=value) for key, value in values.items()]
        name = f"{self._node.get_name()}: decoder"
        content = health(status=[status(level=bytes([level]), name=name, message=message, values=pairs)])
        content.header.stamp = self._node.get_clock().now().to_msg()
        self._health.publish(content)

    def _make_health(self, node: Any) -> tuple[Any, tuple[Any, Any, Any]]:
        try:
            from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
        except ImportError:
            say("ros2: diagnostic_msgs is not installed; nothing is published on /diagnostics")
            return None, (None, None, None)
        return node.create_publisher(DiagnosticArray, DIAGNOSTICS, 10), (
            DiagnosticArray,
            DiagnosticStatus,
            KeyValue,
        )


class GestureNode:
    """A managed node and what its transitions do: `configure` reads parameters, pictures are taken while it is active.

    changed: set when the loop has to look at `run` (None while inactive) and `is_shut_down`. trouble: why the last
    transition failed.
    """

    def __init__(self, settings: DecodeSettings, is_raw: bool) -> None:
        from rcl_interfaces.msg import ParameterDescriptor
        from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

        self.changed = threading.Event()
        self.run: Run | None = None
        self.is_shut_down = False
        self.trouble = ""
        self._given = self._chosen = settings
        self._subscription: Any = None
        self._answers = TransitionCallbackReturn
        self.node = LifecycleNode(NAME)
        free = ParameterDescriptor(dynamic_typing=True)
        for name in parameter_names():
            self.node.declare_parameter(name, None, free)
        self.node.declare_parameter(RAW, is_raw)
        self.node.add_managed_entity(self)
        self.wire = Wire2(self.node)

    def start_by_itself(self) -> None:
        """Configure and activate. UsageError: why it cannot be."""
        for change in (self.node.trigger_configure, self.node.trigger_activate):
            if change() != self._answers.SUCCESS:
                raise UsageError(self.trouble)

    def note_end(self, run: Run) -> None:
        """The loop is through with a run."""
        if self.run is run:
            self.run = None

    def on_configure(self, _state: Any) -> Any:
        """Read the parameters."""
        values = {name: self.node.get_parameter(name).value for name in parameter_names()}
        plain = {name: list(value) if isinstance(value, array) else value for name, value in values.items()}
        try:
            self._chosen = settings_with(self._given, plain)
            check(self._chosen)
        except UsageError as error:
            self.trouble = str(error)
            self.node.get_logger().error(self.trouble)
            return self._answers.FAILURE
        return self._answers.SUCCESS

    def on_activate(self, _state: Any) -> Any:
        """Subscribe."""
        from rclpy.qos import QoSProfile, ReliabilityPolicy
        from sensor_msgs.msg import CompressedImage, Image

        is_raw = bool(self.node.get_parameter(RAW).value)
        source = TopicSource(self.node.resolve_topic_name(IMAGE[is_raw]), say)
        # As sensors publish, but for the depth: an old picture is of no use.
        newest = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        kind = Image if is_raw else CompressedImage
        self._subscription = self.node.create_subscription(kind, IMAGE[is_raw], source.put, newest)
        self.run = Run(self._chosen, source)
        self.changed.set()
        return self._answers.SUCCESS

    def on_deactivate(self, _state: Any) -> Any:
        """Take no more pictures; an open sentence is dropped."""
        if self._subscription is not None:
            self.node.destroy_subscription(self._subscription)
            self._subscription = None
        if self.run is not None:
            self.run.end()
        return self._answers.SUCCESS

    def on_cleanup(self, _state: Any) -> Any:
        """Ready to be configured anew."""
        return self._answers.SUCCESS

    def on_error(self, state: Any) -> Any:
        """Whatever failed, take no more pictures."""
        return self.on_deactivate(state)

    def on_shutdown(self, state: Any) -> Any:
        """The end of the node."""
        self.is_shut_down = True
        self.changed.set()
        return self.on_deactivate(state)


def make_node(settings: DecodeSettings, is_raw: bool) -> GestureNode:
    """The node, not yet configured."""
    from rclpy.lifecycle import ManagedEntity

    # rclpy takes only what has its own base class, which is not there when this module is imported.
    node: GestureNode = type("ManagedGestureNode", (GestureNode, ManagedEntity), {})(settings, is_raw)
    return node
