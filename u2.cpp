#include "map/occupancy/tile_builder.cpp"
#include "map/occupancy/tiled_occupancy.cpp"
