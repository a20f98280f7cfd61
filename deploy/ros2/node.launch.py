"""Starts the node beside a camera: ros2 launch deploy/ros2/node.launch.py image:=/camera/image_raw/compressed

Other arguments: namespace:=/rov, and params:=FILE.yaml with the node's parameters. For Image topics set `raw: true`
there.
"""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "image": ("/camera/image_raw/compressed", "topic with the pictures"),
    "namespace": ("", "of the node and its topics"),
    "params": (str(Path(__file__).with_name("node.yaml")), "file with the node's parameters"),
}


def generate_launch_description() -> LaunchDescription:
    """The arguments and the node."""
    given = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    node = Node(
        executable="lightgesture",  # on the path, as pip installs it
        arguments=["ros2"],  # and --managed where a lifecycle manager shall configure and activate it
        name="lightgesture",
        namespace=given["namespace"],
        parameters=[given["params"]],
        remappings=[("image", given["image"]), ("image/compressed", given["image"])],
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )
    arguments = [
        DeclareLaunchArgument(name, default_value=value, description=text)
        for name, (value, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*arguments, node])
