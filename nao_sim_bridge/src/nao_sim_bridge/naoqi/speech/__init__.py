"""NAOqi's modules that speak and understand: ALTextToSpeech, ALAnimatedSpeech, ALSpeechRecognition."""
