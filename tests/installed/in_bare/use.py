"""The three uses, by the module that is installed, on the maps of data/."""

import importlib.metadata

import numpy
import roadbed

DATA = "/try/data/"
assert importlib.metadata.version("roadbed") == roadbed.__version__
town = roadbed.open(DATA + "town.xodr")
found = town.locate(numpy.array([[150.0, 198.0]]))
assert town.lanes[int(found.lane[0])].name == "1/3/1", found
route = town.route((150, 198), "lane:7/0/1@35")
assert route, route.reason
line = route.reference_line()
plan = line.plan(pose=(150, 198.25, 0), speed_mps=8)
audit = roadbed.Occupancy.open(DATA + "town.bt").audit(plan.trajectory, unknown="free")
print(town, route, plan, audit, sep="\n")
roadbed.open(DATA + "crossing.osm").save("/tmp/crossing_by_module.geojson")  # asks PROJ
