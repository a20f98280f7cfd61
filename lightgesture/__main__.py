"""`python -m lightgesture`."""

import sys

from lightgesture.cli import main

sys.exit(main())
