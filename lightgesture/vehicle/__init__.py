"""A vehicle that obeys: a profile says what each instruction does, the executor does it within its limits and says
so."""

from lightgesture.vehicle.interface import (
    NEUTRAL,
    Order,
    Picture,
    ReadParameter,
    Reply,
    SendCommand,
    SendValue,
    SetMode,
    StartMission,
    Status,
    Stick,
    StopPictures,
    TakePictures,
    Vehicle,
    WriteParameter,
)

__all__ = [
    "NEUTRAL",
    "Order",
    "Picture",
    "ReadParameter",
    "Reply",
    "SendCommand",
    "SendValue",
    "SetMode",
    "StartMission",
    "Status",
    "Stick",
    "StopPictures",
    "TakePictures",
    "Vehicle",
    "WriteParameter",
]
