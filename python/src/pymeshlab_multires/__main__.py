"""python -m pymeshlab_multires: filters over many meshes. See batch/."""

import sys

from .batch.arguments import batch
from .batch.run import run


def main() -> int:
    """The exit code: 0 if no mesh failed, 1 if one did."""
    asked = batch()
    try:
        records = run(asked)
    except KeyboardInterrupt:
        print("interrupted; --resume goes on from here", file=sys.stderr)
        return 130
    failed = sum(record["status"] != "ok" for record in records)
    if not asked.quiet:
        print(f"{len(records)} meshes, {failed} failed; reports in {asked.table}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
