"""A node of ROS: pictures of a topic in, instructions, state and annotated pictures out.

What is the same in ROS 1 and 2 stands in `source`, `listener` and `running`; `node1` and `node2` join it to `rospy` and
`rclpy`, which users bring themselves and which are imported only when a node is made.
"""
