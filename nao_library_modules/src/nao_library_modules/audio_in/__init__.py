"""The server nao_audio_in: recordings, words, sounds and their directions, energies."""

from ..core.lazy import door

__all__ = ["NaoAudioInput"]
__getattr__ = door(__name__, {"NaoAudioInput": "audio_in_server"})
