#!/bin/sh
# Starts the decoder as an extension of BlueOS. Settings are kept in the volume: lightgesture.toml, and source, one line that names
# the stream. What is not there yet is put there; what is there is left alone.
set -eu
data=${LIGHTGESTURE_DATA:-/data}
here=$(dirname "$0")

mkdir -p "$data"
[ -e "$data/lightgesture.toml" ] || cp "$here/lightgesture.toml" "$data/lightgesture.toml"
[ -e "$data/source" ] || echo "rtp://0.0.0.0:5600" > "$data/source"

source=""
read -r source < "$data/source" || true # a last line without its end is read all the same
if [ -z "$source" ]; then
    echo "$data/source: is empty; write the stream's address, such as rtp://0.0.0.0:5600" >&2
    exit 2
fi

set -- lightgesture live "$source" --config "$data/lightgesture.toml"
if [ "$(id -u)" = 0 ] && id lightgesture > /dev/null 2>&1; then
    chown -R lightgesture: "$data"
    exec setpriv --reuid=lightgesture --regid=lightgesture --clear-groups --no-new-privs "$@"
fi
exec "$@"
