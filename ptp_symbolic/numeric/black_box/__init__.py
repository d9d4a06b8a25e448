"""Rivals without physics: functions of the measured motion, learned from the residual torque."""
