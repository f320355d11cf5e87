"""What is stale in a city is redone at set times, by Airflow's own timer.

Airflow keeps the history and makes up for missed times once (`catchup`); the city's
lock keeps its runs apart from others. What differs from place to place is told by the
environment of Airflow's workers:

    NOSTALGIN_CITY       the city folder, on a disk that the workers see
    NOSTALGIN_CRON       when, as `17 3 * * *`, in UTC
    NOSTALGIN_BUDGET     stale photographs at most, each time; 0: all
    NOSTALGIN_COMMAND    the program, where it is not on the path
    NOSTALGIN_OPTIONS    more options of `reprocess`, as --direct_num_workers=4
"""

import os
from datetime import UTC, datetime, timedelta

from airflow.providers.standard.operators.bash import BashOperator
from airflow.sdk import DAG

# Words are read by the shell that runs the task, and none of them as a program.
COMMAND = """
exec "${NOSTALGIN_COMMAND:-nostalgin}" reprocess "${NOSTALGIN_CITY:?names no city}" \
  --budget "${NOSTALGIN_BUDGET:-5000}" --json ${NOSTALGIN_OPTIONS:-}
"""

with DAG(
    dag_id="nostalgin",
    description="What is stale in a city is redone, and published.",
    schedule=os.environ.get("NOSTALGIN_CRON", "17 3 * * *"),
    start_date=datetime(2026, 1, 1, tzinfo=UTC),
    catchup=False,
    max_active_runs=1,
    default_args={"retries": 2, "retry_delay": timedelta(minutes=10)},
    doc_md=__doc__,
):
    BashOperator(task_id="reprocess", bash_command=COMMAND)
