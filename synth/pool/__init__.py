"""A pool: a vehicle that speaks MAVLink as ArduSub does, the synthetic diver before its camera, and trials."""
