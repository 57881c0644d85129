#include "roadbed/control/stanley.h"
