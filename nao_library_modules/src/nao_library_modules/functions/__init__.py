"""Chains of functions: binding to parameters, checks, running, and what describes them."""
