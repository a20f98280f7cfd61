"""A vehicle's profile, pictures and time, made up for tests of the executor."""

import time

from lightgesture.vehicle import Picture

BASE = 'name = "T"\n[modes]\nA = 1\nB = 2\n[safety]\nneeds_armed = false\n'


def pictured(number):
    return Picture(number=number, place=f"/dcim/{number}.jpg")


def wait_for(condition, tries=200):
    for _ in range(tries):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("it did not come")
