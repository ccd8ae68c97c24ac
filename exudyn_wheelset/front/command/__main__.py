"""`python -m exudyn_wheelset.front.command TASK`: the command without its script."""

import sys

from exudyn_wheelset.front.command import main

sys.exit(main())
