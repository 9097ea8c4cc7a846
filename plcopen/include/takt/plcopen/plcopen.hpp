#pragma once

/// All function blocks.
#include <takt/plcopen/enums.hpp>
#include <takt/plcopen/mc_group.hpp>
#include <takt/plcopen/mc_group_move.hpp>
#include <takt/plcopen/mc_group_read.hpp>
#include <takt/plcopen/mc_home.hpp>
#include <takt/plcopen/mc_jog.hpp>
#include <takt/plcopen/mc_move.hpp>
#include <takt/plcopen/mc_path.hpp>
#include <takt/plcopen/mc_power.hpp>
#include <takt/plcopen/mc_read.hpp>
#include <takt/plcopen/mc_stop.hpp>
