"""What the consumer tests share."""
import os
import re
import shutil
import subprocess
import sys


def run(*command, **options):
    """Runs a command, shows it and what it said if it failed, and returns what it printed."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            **options)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}\nexit status {result.returncode}")
    return result.stdout


def fresh(directory):
    shutil.rmtree(directory, ignore_errors=True)
    os.makedirs(directory)
    return directory


def speed(output):
    return float(re.search(r"right block:\s*(\S+)", output).group(1))
