"""A compiler for ABB RAPID robot programs that saves energy."""

from ._joulepath import JoulepathError, Load, Robot, RobotError, robots

__all__ = ["JoulepathError", "Load", "Robot", "RobotError", "robots"]
