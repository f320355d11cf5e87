"""A worker of Beam that has forked its supervisor before it starts a thread."""

import sys

from pipelines import stopping
from pipelines.build.isolation import POOL
from pipelines.models import one_thread

if __name__ == "__main__":
    stopping.left_to_the_driver()
    import pipelines.build.blocks  # noqa: F401 - what both will need, loaded once

    one_thread()
    POOL.fill()
    from apache_beam.runners.worker import sdk_worker_main

    sdk_worker_main.main(sys.argv)
