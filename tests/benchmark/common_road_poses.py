"""Times `commonroad-drivability-checker` from PyPI on the scene of `bench_occupancy --dump DIR`.

    python3 -m venv env && env/bin/pip install commonroad-drivability-checker
    bench_occupancy --dump DIR && taskset -c 1 env/bin/python common_road_poses.py DIR

Collisions of a car's rectangle with the occupied cells as boxes, pose by pose and in one call for
all poses. CPU time, medians. The times of single calls hold the way from Python, some hundred ns.
"""

import math
import statistics
import sys
import time

import commonroad_dc.pycrcc as pycrcc

LENGTH_M, WIDTH_M, REAR_M = 4.508, 1.610, 0.8312829


def rows_of(path: str) -> list[list[float]]:
    with open(path, encoding="utf-8") as file:
        next(file)
        return [[float(word) for word in line.split(",")] for line in file]


def median_s(work, reps: int = 5) -> float:
    times = []
    for _ in range(reps):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return statistics.median(times)


def main() -> None:
    boxes = pycrcc.ShapeGroup()
    for least_x, least_y, most_x, most_y in rows_of(sys.argv[1] + "/boxes.csv"):
        boxes.add_shape(
            pycrcc.RectAABB(
                (most_x - least_x) / 2,
                (most_y - least_y) / 2,
                (most_x + least_x) / 2,
                (most_y + least_y) / 2,
            )
        )
    checker = pycrcc.CollisionChecker()
    checker.add_collision_object(boxes)
    middle_m = LENGTH_M / 2 - REAR_M
    cars = [
        pycrcc.RectOBB(
            LENGTH_M / 2,
            WIDTH_M / 2,
            heading,
            x + middle_m * math.cos(heading),
            y + middle_m * math.sin(heading),
        )
        for x, y, heading in rows_of(sys.argv[1] + "/poses.csv")[:20000]
    ]
    clear = sum(not checker.collide(car) for car in cars)
    seconds = median_s(lambda: [checker.collide(car) for car in cars])
    print(
        f"| commonroad-drivability-checker, collide() pose by pose "
        f"| {len(cars) / seconds / 1e6:.2f} M poses/s | {1e3 * seconds:.0f} ms |"
    )
    print(f"{clear} of {len(cars)} poses clear")


main()
