"""What a choice of the shading model gives and takes: accuracy against cost, rung by rung of a ladder.

``measure.measure`` makes one dict of numbers of a project and its ladder (docs/trade.md describes it).
"""
