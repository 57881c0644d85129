#include "roadbed/planning/route.h"
