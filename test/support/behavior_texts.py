"""Behaviours for tests."""

from __future__ import annotations

EVERYTHING = """
help: Waves and
  says hello.
tags: [greeting]
parameters:
  text: {default: "Hello!", help: what it says}
  count: {default: 2, help: how often, min: 1, max: 5, unit: times}
  colour: {default: green, help: of the eyes, choices: [green, red]}
do:
  - NaoMotion.goToPosture: {str_param: Stand}
  - parallel:
      - nao_audio_out.say: {str_param: "${text}"}
      - [{NaoLights.setColor: {lights: [FaceLeds], str_param: "${colour}"}}, {wait: 0.5}]
  - timeline:
      - {NaoLights.on: {lights: [FaceLeds]}, at: 0.5, label: eyes}
      - {wait: 1, at: eyes.end + 0.5}
      - {wait: 1, at: "eyes + ${count / 2}"}
      - {barrier: all}
      - {wait: 0, at: all}
  - behavior: bow
    parameters: {depth: 0.3}
  - chain: {NaoLights: [{function: on, lights: [A]}, {function: off, lights: [A]}]}
  - {repeat: "${count}", as: round, do: [{wait: "${round}"}]}
  - {label: x, on_error: retry 2 skip, for: 3.0, NaoVision.lookFor: {str_param: ball}}
  - {do: [{wait: 1}], on_error: skip}
"""
"""A file with everything that a file may hold."""
