#!/usr/bin/env python3
"""Compares the time of a Batch with that of its simulations one after the other, in one run, and checks that the bits are the same.

    PYTHONPATH=build/release/python build/release/python_env/bin/python bench/batch.py [--simulations 8] [--threads 2] [--frames 30] [--rounds 3]
"""
import argparse
import time

import toile


def sheets(count):
    """Sheets of some 2,600 vertices that fall on a cylinder, each from a different height."""
    made = []
    for k in range(count):
        cloth = toile.Cloth.grid(width_m=1, height_m=1, edge_m=0.0214).place((0, 0.02 + 0.01 * k, 0), rotation_deg=(-90, 0, 0))
        made.append(toile.Simulation(cloth, "cotton", toile.Body.cylinder(radius_m=0.2, height_m=0.5), threads=1))
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--simulations", type=int, default=8)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    one_by_one, together = sheets(options.simulations), sheets(options.simulations)
    batch = toile.Batch(together, threads=options.threads)
    alone_s = batch_s = 0.0
    for _ in range(options.rounds):
        begin = time.perf_counter()
        for sim in one_by_one:
            for _ in range(options.frames):
                sim.advance(1 / 30)
        middle = time.perf_counter()
        for _ in range(options.frames):
            batch.advance(1 / 30)
        alone_s += middle - begin
        batch_s += time.perf_counter() - middle
        print(f"one after the other {alone_s:.2f} s, batch {batch_s:.2f} s, {alone_s / batch_s:.2f} times")
    same = all(a.state_hash == b.state_hash for a, b in zip(one_by_one, together))
    print(f"{options.simulations} simulations of {len(together[0].positions_m)} vertices on {options.threads} threads; the same bits: {'yes' if same else 'NO'}")


if __name__ == "__main__":
    main()
