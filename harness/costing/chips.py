"""The GPUs that costs are counted for, by the names that the driver has for their families."""

from __future__ import annotations

CHIPS = {
    "tahiti": "GCN 1: Radeon HD 7900",
    "polaris10": "GCN 4: Radeon RX 480, PlayStation 4 Pro",
    "vega10": "GCN 5: Radeon RX Vega",
    "navi10": "RDNA 1: Radeon RX 5700",
    "navi21": "RDNA 2: Radeon RX 6800, PlayStation 5, Xbox Series, Steam Deck",
    "gfx1100": "RDNA 3: Radeon RX 7900",
}
TARGETS = ("vega10", "navi21", "gfx1100")
