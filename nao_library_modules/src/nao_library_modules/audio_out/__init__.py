"""The server nao_audio_out: speech, sound files, tones, volumes."""

from ..core.lazy import door

__all__ = ["NaoAudioOutput"]
__getattr__ = door(__name__, {"NaoAudioOutput": "audio_out_server"})
