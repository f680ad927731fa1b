# One line a shard, and errors, instead of the ten lines that Snakemake says of each job; its log has those.
import logging
import sys

from snakemake.logging import logger


def log_handler(message):
    logger.stream_handler.setLevel(logging.ERROR)
    shards = message.get("total", 0) - 1  # the rule that wants them all is a job, too
    if message["level"] == "progress" and message["done"] <= shards:
        print(f"pipeline: {message['done']} of {shards} shards done", file=sys.stderr, flush=True)
