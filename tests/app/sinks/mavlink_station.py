"""What the tests of MAVLink share."""

from lightgesture.sinks.mavlink import MavlinkSink


def send(link, *records, mapping=None):
    sink = MavlinkSink(link, mapping)
    sink.open()
    for record in records:
        assert sink.wants(record)
        sink.send(record)
    sink.close()
