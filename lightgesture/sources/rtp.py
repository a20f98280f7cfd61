"""Pictures that a vehicle sends to a port of this machine, by RTP: H.264, H.265, JPEG, or a transport stream.

BlueROV's and ArduPilot's cameras send H.264 to port 5600, where QGroundControl listens. The packets themselves do not
say how they are coded: that stands in a description (SDP, RFC 8866), a file that the user names, or is found by looking
at what comes.
"""

import socket
import struct
import time
from io import BytesIO
from ipaddress import ip_address
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

from lightgesture.errors import InputError, UsageError, reason_of
from lightgesture.features.files import read_whole
from lightgesture.sources import types
from lightgesture.sources.address import hide_login
from lightgesture.sources.network import NetworkStream

if TYPE_CHECKING:
    from av.container import InputContainer

USUAL_PORT: Final = 5600
LARGEST_DESCRIPTION: Final = 1 << 16
"""Bytes of a file of SDP; cameras write some hundreds."""

_PROTOCOLS = "udp,rtp,srtp"
_JPEG, _TRANSPORT_STREAM, _DYNAMIC = 26, 33, 96
"""Payload types of RFC 3551; from the last one on they mean what the two sides agree upon."""

_OPTIONS = {"protocol_whitelist": _PROTOCOLS, "fflags": "nobuffer", "analyzeduration": "1000000"}
_H265_FIRST_BYTES = frozenset(kind << 1 for kind in (1, 19, 32, 33, 34, 48, 49))
_H264_KINDS = frozenset({1, 5, 7, 24, 28})
_SYNC_BYTE, _TS_PACKET = 0x47, 188


class RtpStream(NetworkStream):
    """The pictures of an RTP stream as they come; damaged ones are passed over.

    description: an SDP; empty: host and port of `name` are listened at, and what comes there is described.
    """

    def __init__(self, name: str, description: bytes = b"") -> None:
        super().__init__(name, hide_login(name))
        self._description = description
        self._place = ("", 0) if description else _listen_at(name)

    def open(self) -> "InputContainer":
        """A container of what comes. InputError: nothing does, or the port is taken."""
        import av

        return av.open(
            BytesIO(self._description or self._look()),
            "r",
            format="sdp",
            timeout=types.TIMEOUT_S,
            options=_OPTIONS,
        )

    def _look(self) -> bytes:
        """A description of what comes to the port."""
        host, port = self._place
        try:
            with _bound(host, port) as peer:
                return _describe(host, port, *_first_packet(self.name, peer))
        except TimeoutError:
            raise InputError(
                f"{self.name}: nothing came for {types.TIMEOUT_S:g} s; does the vehicle send to this machine's port "
                f"{port}?"
            ) from None
        except OSError as error:
            raise InputError(
                f"{self.name}: cannot be listened at ({reason_of(error)}); end other programs at this port, such as "
                "QGroundControl, and name an address of this machine, or 0.0.0.0 for all"
            ) from None


def read_description(path: str) -> RtpStream:
    """The stream that a file of SDP describes, not yet opened. UsageError: it is none."""
    try:
        content = read_whole(path, LARGEST_DESCRIPTION)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror}); name a file of SDP") from None
    lines = content.split()
    if not content.lstrip().startswith(b"v=") or not any(line.startswith(b"m=video") for line in lines):
        raise UsageError(
            f"{path}: is no SDP with a line m=video; write it as the camera or its manual has it"
        )
    return RtpStream(path, content)


def _listen_at(address: str) -> tuple[str, int]:
    """Host and port of an address, which are this machine's, or a group's. UsageError: they are none."""
    example = f"write rtp://0.0.0.0:{USUAL_PORT}"
    name = hide_login(address)
    try:
        parts = urlsplit(address)
        host, port = parts.hostname or "0.0.0.0", parts.port
        ip_address(host)
    except ValueError:
        raise UsageError(f"{name}: names no address and port of this machine; {example}") from None
    if not port:
        raise UsageError(f"{name}: names no port; {example}")
    return host, port


def _bound(host: str, port: int) -> socket.socket:
    """A socket that hears what comes. OSError: the port is taken, or the address another machine's."""
    address = ip_address(host)
    peer = socket.socket(socket.AF_INET if address.version == 4 else socket.AF_INET6, socket.SOCK_DGRAM)
    try:
        peer.bind((host, port))
        if address.is_multicast and address.version == 4:
            group = struct.pack("4s4s", address.packed, socket.inet_aton("0.0.0.0"))
            peer.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group)
    except OSError:
        peer.close()
        raise
    return peer


def _first_packet(name: str, peer: socket.socket) -> tuple[int, str]:
    """Payload type and coding of the first packet that shows it. TimeoutError: none came."""
    deadline_s = time.monotonic() + types.TIMEOUT_S
    is_heard = False
    while (left_s := deadline_s - time.monotonic()) > 0:
        peer.settimeout(left_s)
        try:
            packet = peer.recv(1 << 16)
        except TimeoutError:
            break
        is_heard = True
        if packet[:1] == bytes([_SYNC_BYTE]) and len(packet) % _TS_PACKET == 0:
            raise InputError(
                f"{name}: sends a transport stream without RTP; name it udp:// in place of rtp://"
            )
        payload_type, coding = _coding(packet)
        if coding:
            return payload_type, coding
    if is_heard:
        raise InputError(
            f"{name}: sends what is neither H.264 nor H.265 by RTP; describe it in a file of SDP"
        )
    raise TimeoutError


def _coding(packet: bytes) -> tuple[int, str]:
    """Payload type of a packet of RTP, and what is coded in it: empty where it does not show."""
    if len(packet) < 14 or packet[0] >> 6 != 2:
        return 0, ""
    payload_type = packet[1] & 0x7F
    if payload_type in (_JPEG, _TRANSPORT_STREAM):
        return payload_type, "JPEG" if payload_type == _JPEG else "MP2T"
    start = 12 + 4 * (packet[0] & 0x0F)
    if packet[0] & 0x10 and len(packet) >= start + 4:
        start += 4 + 4 * int.from_bytes(packet[start + 2 : start + 4], "big")
    head = packet[start : start + 2]
    if payload_type < _DYNAMIC or len(head) < 2 or 72 <= payload_type <= 76:  # the last are reports
        return payload_type, ""
    if head[1] == 1 and head[0] in _H265_FIRST_BYTES:  # kind of the unit; layer 0, time layer 1
        return payload_type, "H265"
    return payload_type, "H264" if head[0] & 0x1F in _H264_KINDS else ""


def _describe(host: str, port: int, payload_type: int, coding: str) -> bytes:
    kind = f"IP{ip_address(host).version}"
    lines = [
        *("v=0", f"o=- 0 0 IN {kind} {host}", "s=lightgesture", f"c=IN {kind} {host}", "t=0 0"),
        f"m=video {port} RTP/AVP {payload_type}",
    ]
    if payload_type >= _DYNAMIC:
        lines.append(f"a=rtpmap:{payload_type} {coding}/90000")
    return "".join(f"{line}\r\n" for line in lines).encode("ascii")
