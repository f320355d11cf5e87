"""Examples that `--help` shows below each command's options."""

from typing import Final

EXPLAIN: Final = """
Examples:

  nostalgin explain photo.jpg -o out         [dim]# pictures and explain.json in out/[/]

  nostalgin explain photo.jpg -o out --no-placard
"""

INDEX: Final = """
Examples:

  nostalgin index photos --catalogue list.csv -o city

  nostalgin index photos -o city                      [dim]# file names tell the lots[/]

  nostalgin index photos --catalogue list.csv -o city --block 993

  nostalgin index photos -o city --title "Midtown, 1940"
"""

BUILD: Final = """
Examples:

  nostalgin build city                            [dim]# in this process[/]

  nostalgin build city --direct_num_workers 2     [dim]# two processes[/]

  nostalgin build city --shard 3/16               [dim]# every sixteenth block[/]

  nostalgin build city --runner FlinkRunner --flink_master host:8081
"""

VIEW: Final = """
Examples:

  nostalgin view city

  nostalgin view city --port 8000 --no-browser
"""

DEMO: Final = """
Examples:

  nostalgin demo                                  [dim]# two blocks in demo-city/[/]

  nostalgin demo --blocks 1 --direct_num_workers 2
"""
