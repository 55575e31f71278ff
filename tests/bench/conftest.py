"""Makes ``import bench`` find the package at the root, however pytest was started, and not this folder."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
