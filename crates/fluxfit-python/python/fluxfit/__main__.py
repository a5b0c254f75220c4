"""`python -m fluxfit`: the command."""

import sys

from fluxfit._command import main

sys.exit(main())
