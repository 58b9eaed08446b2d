"""Speech, its recognition, sounds and microphones."""
